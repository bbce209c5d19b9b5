#include "conductor/level_crossings.h"

namespace fsr::conductor {

namespace {

constexpr double kLow = 0.1, kHigh = 0.9;  // shares of the way
constexpr double kStalled = 15;            // time without a rise until a complaint [s]

double crossing(const Reading& a, const Reading& b, double level) {
  return a.time + (b.time - a.time) * (level - a.pressure) / (b.pressure - a.pressure);
}

}  // namespace

LevelCrossings::LevelCrossings(double low, double peak)
    : low_level_(low + kLow * (peak - low)), high_level_(low + kHigh * (peak - low)) {}

void LevelCrossings::take(const Reading& now) {
  if (last_) {
    const auto rises = [&](double level) { return last_->pressure < level && now.pressure >= level; };
    const auto falls = [&](double level) { return last_->pressure >= level && now.pressure < level; };
    if (rises(low_level_) && !up_high_) up_low_ = crossing(*last_, now, low_level_);
    if (rises(high_level_) && !up_high_) up_high_ = crossing(*last_, now, high_level_);
    if (falls(high_level_)) down_high_ = crossing(*last_, now, high_level_);
    if (falls(low_level_) && down_high_ && !down_low_) down_low_ = crossing(*last_, now, low_level_);
  }
  if (!last_ || now.pressure > highest_ + 0.01 * (high_level_ - low_level_)) {
    highest_ = now.pressure;
    risen_ = now.time;
  }
  last_ = now;
}

std::optional<double> LevelCrossings::fillRate() const {
  if (!up_low_ || !up_high_ || !(*up_high_ > *up_low_)) return std::nullopt;
  return (high_level_ - low_level_) / (*up_high_ - *up_low_);
}

std::optional<double> LevelCrossings::ventRate() const {
  if (!down_low_ || !(*down_low_ > *down_high_)) return std::nullopt;
  return (high_level_ - low_level_) / (*down_low_ - *down_high_);
}

double LevelCrossings::timeAbove() const {
  if (!up_high_) return 0;
  return (down_high_ ? *down_high_ : last_->time) - *up_high_;
}

Hint LevelCrossings::stalledHint(double peak) const {
  if (!last_ || up_high_ || last_->time - risen_ < kStalled) return {};
  return {Reason::kChamberStalled, "the pressure stays at " + kPaText(last_->pressure) +
                                       " and does not rise to " + kPaText(peak) +
                                       "; check supply and valves, or skip this step"};
}

}  // namespace fsr::conductor
