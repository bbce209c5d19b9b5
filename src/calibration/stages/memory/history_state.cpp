#include "calibration/stages/memory/history_state.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace fsr::calibration {

namespace {

constexpr double kLargest = 1e30;    // answer [Pa]; a map holds no infinite pressure
constexpr double kNegligible = 0.1;  // of the smallest deviation: it then grows by 0.5 %

std::vector<double> weightsOf(const HistoryModel& model) {
  std::vector<double> weights = model.play_weight;
  weights.insert(weights.end(), model.memory_weight.begin(), model.memory_weight.end());
  return weights;
}

// Of inputs evenly between the knots, where the model has none.
std::vector<double> spreadsOf(const HistoryModel& model) {
  if (!model.memory_spread.empty()) return model.memory_spread;
  return std::vector<double>(model.time_constant.size(),
                             (model.knot.back() - model.knot.front()) / std::sqrt(12.0));
}

}  // namespace

HistoryOperators::HistoryOperators(std::vector<double> radii, const std::vector<double>& time_constants,
                                   double highest)
    : radii_(std::move(radii)), memories_(time_constants.begin(), time_constants.end()), highest_(highest) {
  for (const double radius : radii_) {
    if (!(radius > 0)) throw std::invalid_argument("the radius of a play must be above 0");
  }
}

OpenDeviation::OpenDeviation(std::vector<double> weights, const std::vector<double>& radii,
                             const std::vector<double>& spreads)
    : each_(std::move(weights)) {
  const std::size_t plays = radii.size();
  double whole = 0;
  for (std::size_t k = 0; k < each_.size(); ++k) {
    each_[k] = std::abs(each_[k]) * (k < plays ? 1 / std::sqrt(3.0) : spreads[k - plays]);
    whole += each_[k] * (k < plays ? radii[k] : 1);
  }
  if (whole > 0) per_whole_ = 1 / whole;
}

HistoryState::HistoryState(const HistoryModel& model, std::size_t taxels)
    : operators_(model.radius, model.time_constant, model.knot.back()),
      weights_(weightsOf(model)),
      correction_(model.knot, model.correction),
      loading_deviation_(model.deviation_knot, model.loading_deviation),
      unloading_deviation_(model.deviation_knot, model.unloading_deviation),
      open_deviation_(weights_, model.radius, spreadsOf(model)),
      negligible_(kNegligible * model.smallestDeviation()),
      steps_(operators_.memories()),
      spell_steps_(operators_.memories()),
      known_(taxels, Known::kNothing),
      taxels_(taxels),
      limited_(taxels),
      states_(taxels * operators_.size()),
      open_(taxels * operators_.size()) {
  for (const double weight : weights_) weight_sum_ += weight;
}

void HistoryState::forget() noexcept {
  std::fill(known_.begin(), known_.end(), Known::kNothing);
}

void HistoryState::rest() noexcept {
  std::fill(known_.begin(), known_.end(), Known::kRest);
}

void HistoryState::beginScan(double time) noexcept {
  if (!std::isfinite(time)) return;
  const double duration = time - time_;
  if (started_ && duration < 0) forget();
  started_ = true;
  before_ = time_;
  time_ = time;
  if (duration == duration_ || !(duration >= 0)) return;
  operators_.stepsOver(duration, steps_.data());
  duration_ = duration;
}

// Taxels that return together share their steps.
const HistoryState::Steps& HistoryState::stepsOfSpell(double duration) noexcept {
  if (duration != spell_) operators_.stepsOver(duration, spell_steps_.data());
  spell_ = duration;
  return spell_steps_;
}

void HistoryState::atLeast(std::size_t taxel, double pressure) noexcept {
  if (!std::isfinite(pressure)) return;
  taxels_[taxel].limit = pressure;
  limited_[taxel] = time_;
}

// Takes a reading into the state of a taxel.
void HistoryState::meet(std::size_t taxel, double x) noexcept {
  HistoryTaxel& own = taxels_[taxel];
  double* const state = &states_[taxel * operators_.size()];
  double* const open = &open_[taxel * operators_.size()];
  if (known_[taxel] != Known::kReadings) {
    operators_.start(x, state, open);
    own.open = known_[taxel] == Known::kNothing;
    known_[taxel] = Known::kReadings;
  } else if (own.at < before_ || time_ - own.at > kLongestGap) {
    if (!own.open) std::fill_n(open, operators_.size(), 0.0);
    if (limited_[taxel] != before_) own.limit = -HistoryOperators::kNone;
    operators_.advanceUnseen(own.last, x, own.limit, stepsOfSpell(time_ - own.at).data(), state, open);
    own.open = true;
  } else if (own.open) {
    operators_.advanceOpen(own.last, x, steps_.data(), state, open);
  } else {
    operators_.advance(own.last, x, steps_.data(), state);
  }
  own.last = x;
  own.at = time_;
  own.limit = -HistoryOperators::kNone;
}

HistoryAnswer HistoryState::correct(std::size_t taxel, bool frozen, float& pressure,
                                    float& deviation) noexcept {
  const double x = static_cast<double>(pressure);
  if (frozen || !std::isfinite(x)) {
    // The next reading may be one under load.
    if (known_[taxel] == Known::kRest) known_[taxel] = Known::kNothing;
    return HistoryAnswer::kNoReading;
  }
  meet(taxel, x);
  HistoryTaxel& own = taxels_[taxel];
  const double* const state = &states_[taxel * operators_.size()];
  const double unknown = own.open ? open_deviation_(&open_[taxel * operators_.size()]) : 0;
  double sum = 0;
  for (std::size_t k = 0; k < weights_.size(); ++k) sum += weights_[k] * state[k];
  const double corrected = x + correction_(x) * open_deviation_.knownShare(unknown) + (sum - weight_sum_ * x);
  if (!(std::abs(corrected) < kLargest)) return HistoryAnswer::kNoReading;
  pressure = static_cast<float>(corrected);
  const bool unloading = !weights_.empty() && state[0] > x;
  const double settled = unloading ? unloading_deviation_(corrected) : loading_deviation_(corrected);
  own.open = unknown > negligible_;
  deviation = static_cast<float>(own.open ? std::hypot(settled, unknown) : settled);
  return isSettled(settled, unknown) ? HistoryAnswer::kSettled : HistoryAnswer::kOpen;
}

}  // namespace fsr::calibration
