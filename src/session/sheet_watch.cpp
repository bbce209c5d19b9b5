#include "session/sheet_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fsr::session {

namespace {

// Of normal noise, one reading in 3.5 million is further above its mean.
constexpr double kBeyondNoise = 5;
// Deviation of max(0, z) for a standard normal z: sqrt(1/2 - 1/(2 pi)).
constexpr double kCutOff = 0.5838;

}  // namespace

void RestCounts::take(const std::uint16_t* counts, std::size_t taxels) {
  if (rest_.size() != taxels) {
    restart();
    rest_.resize(taxels);
    last_.resize(taxels);
    differences_.resize(taxels);
  }
  for (std::size_t t = 0; t < taxels; ++t) {
    if (rest_[t].count > 0) differences_[t] += (counts[t] - last_[t]) * (counts[t] - last_[t]);
    rest_[t].add(counts[t]);
    last_[t] = counts[t];
  }
}

std::size_t RestCounts::answering(const std::uint16_t* counts, std::size_t taxels) const {
  if (!known() || rest_.size() != taxels) return taxels;
  std::size_t answering = 0;
  for (std::size_t t = 0; t < taxels; ++t)
    answering += counts[t] > rest_[t].mean + kBeyondNoise * rest_[t].deviation() + 1 ? 1 : 0;
  return answering;
}

double RestCounts::excess(const std::uint16_t* counts, std::size_t taxels) const {
  if (!known() || rest_.size() != taxels) return std::numeric_limits<double>::quiet_NaN();
  double excess = 0;
  for (std::size_t t = 0; t < taxels; ++t) excess += counts[t] - rest_[t].mean;
  return excess;
}

double RestCounts::noise() const {
  if (!known()) return 0;
  return std::sqrt(statistics::upperMedian(differences_) / (2 * (rest_.front().count - 1))) / kCutOff;
}

namespace {

// Sheet and transducer may be late by this much; the sheet is looked at so long before and behind a jump [s].
constexpr double kLookAround = 0.5;
// A sheet in proportion to the pressure changes by 1. Real ones answer less at high pressures, and keep a
// part behind a load; a ramp at a usual pace changes them by a few percent while they are looked at.
constexpr double kLeastChange = 0.25;
constexpr double kSilentShare = 0.5;  // of the excess at the jump: below, the sheet is unloaded

}  // namespace

bool JumpWatch::isJump(const Reading& before, const Reading& after) {
  const double low = std::max(0.0, std::min(before.pressure, after.pressure));
  const double high = std::max(before.pressure, after.pressure);
  return high - low >= kLoadLevel && low <= 0.5 * high;
}

void JumpWatch::scan(const SheetAnswer& now) {
  // Behind a jump of the clock nothing is known.
  if (!recent_.empty() && now.time < recent_.back().time) recent_.clear();
  recent_.push_back(now);
  while (recent_.front().time < now.time - 3 * kLookAround) recent_.pop_front();
}

void JumpWatch::begin(const Reading& before, const Reading& after) {
  before_ = before;
  after_ = after;
  open_ = true;
}

std::optional<bool> JumpWatch::followed(double time, std::optional<double> answered) {
  const bool seen = !recent_.empty() && recent_.back().time >= after_.time + kLookAround;
  if (!seen && time < after_.time + 2 * kLookAround) return std::nullopt;
  open_ = false;
  const auto first = std::find_if(recent_.begin(), recent_.end(), [this](const SheetAnswer& one) {
    return one.time >= before_.time - kLookAround;
  });
  if (!seen || first == recent_.end() || first->time > before_.time) return true;
  loaded_ = std::max(first->excess, recent_.back().excess);
  return follows(*first, recent_.back(), answered);
}

bool JumpWatch::follows(const SheetAnswer& first, const SheetAnswer& last,
                        std::optional<double> answered) const {
  if (std::isnan(first.excess) || std::isnan(last.excess) || first.saturated || last.saturated) return true;
  const bool up = after_.pressure > before_.pressure;
  const SheetAnswer& low = up ? first : last;
  const SheetAnswer& high = up ? last : first;
  // A sheet that does not answer the higher pressure tells nothing, unless it answered a lower one before.
  if (!high.answers) return !(up && answered && after_.pressure >= *answered);
  const double low_pressure = std::max(0.0, std::min(before_.pressure, after_.pressure));
  const double share = low_pressure / std::max(before_.pressure, after_.pressure);
  return low.excess < high.excess * (1 - kLeastChange * (1 - share));
}

bool JumpWatch::agrees(double pressure) const {
  if (recent_.empty() || std::isnan(recent_.back().excess)) return true;
  const SheetAnswer& last = recent_.back();
  if (pressure > kLoadLevel) return last.answers;
  return !last.answers || last.excess < kSilentShare * loaded_;
}

}  // namespace fsr::session
