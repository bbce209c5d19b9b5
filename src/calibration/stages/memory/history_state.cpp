#include "calibration/stages/memory/history_state.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace fsr::calibration {

HistoryOperators::HistoryOperators(std::vector<double> radii, const std::vector<double>& time_constants)
    : radii_(std::move(radii)), memories_(time_constants.begin(), time_constants.end()) {
  for (const double radius : radii_) {
    if (!(radius > 0)) throw std::invalid_argument("the radius of a play must be above 0");
  }
}

namespace {

constexpr double kLargest = 1e30;  // answer [Pa]; a map holds no infinite pressure
constexpr double kLongAgo = 1e30;  // [s]

}  // namespace

HistoryState::HistoryState(const HistoryModel& model, std::size_t taxels)
    : model_(model),
      operators_(model.radius, model.time_constant),
      weights_(model.play_weight),
      correction_(model.knot, model.correction),
      loading_deviation_(model.deviation_knot, model.loading_deviation),
      unloading_deviation_(model.deviation_knot, model.unloading_deviation),
      settling_time_(model.settlingTime()),
      allowed_(model.smallestDeviation()),
      longest_gap_(model.time_constant.empty() ? kLongestGap : settlingTime(model.time_constant)),
      steps_(operators_.memories()),
      spell_steps_(operators_.memories()),
      known_(taxels, Known::kNothing),
      taxels_(taxels),
      states_(taxels * operators_.size()) {
  weights_.insert(weights_.end(), model.memory_weight.begin(), model.memory_weight.end());
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
  if (started_ && (duration < 0 || duration > longest_gap_)) forget();
  started_ = true;
  before_ = time_;
  time_ = time;
  if (duration == duration_ || !(duration >= 0)) return;
  operators_.stepsOver(duration, steps_.data());
  duration_ = duration;
}

bool HistoryState::settled(const Taxel& taxel) const noexcept {
  return time_ - taxel.since >= settling_time_ && model_.playsOwe(taxel.lowest, taxel.highest) <= allowed_;
}

// Taxels that return together share their steps.
const HistoryState::Steps& HistoryState::stepsOfSpell(double duration) noexcept {
  if (duration != spell_) operators_.stepsOver(duration, spell_steps_.data());
  spell_ = duration;
  return spell_steps_;
}

// The largest error of the memories from an input between the knots that was not known over these steps [Pa].
double HistoryState::memoriesMiss(const Steps& steps) const noexcept {
  double missed = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) missed += std::abs(model_.memory_weight[k]) * steps[k].fade;
  return missed * (model_.knot.back() - model_.knot.front());
}

void HistoryState::atLeast(std::size_t taxel, double pressure) noexcept {
  if (std::isfinite(pressure)) taxels_[taxel].limit = std::max(taxels_[taxel].limit, pressure);
}

bool HistoryState::correct(std::size_t taxel, bool frozen, float& pressure, float& deviation) noexcept {
  const double x = static_cast<double>(pressure);
  Known& known = known_[taxel];
  if (frozen || !std::isfinite(x)) {
    if (known == Known::kRest) known = Known::kNothing;  // the next reading may be one under load
    return false;
  }
  Taxel& own = taxels_[taxel];
  double* const state = &states_[taxel * operators_.size()];
  if (known == Known::kReadings && time_ - own.at > longest_gap_) known = Known::kNothing;
  if (known != Known::kReadings) {
    operators_.startConditioned(x, state);
    const bool rested = known == Known::kRest;
    own = {};
    own.last = own.lowest = own.highest = x;
    own.at = time_;
    own.since = rested ? -kLongAgo : time_;
    own.settled = rested || settled(own);
    known = Known::kReadings;
  } else {
    const bool spell = own.at < before_;  // without a reading of this taxel
    const Steps& steps = spell ? stepsOfSpell(time_ - own.at) : steps_;
    if (spell && own.limit > x) operators_.advancePlays(own.limit, state);
    operators_.advance(own.last, x, steps.data(), state);
    own.last = x;
    own.at = time_;
    if (spell) {  // the load may have been anywhere meanwhile
      own.lowest = x;
      own.highest = std::max(x, own.limit);
      own.limit = -kNoLimit;
      if (memoriesMiss(steps) > allowed_) own.since = time_;
      own.settled = settled(own);
    } else if (!own.settled) {
      own.lowest = std::min(own.lowest, x);
      own.highest = std::max(own.highest, x);
      own.settled = settled(own);
    }
  }
  if (!own.settled) return false;
  double sum = 0;
  for (std::size_t k = 0; k < weights_.size(); ++k) sum += weights_[k] * state[k];
  const double corrected = x + correction_(x) + (sum - weight_sum_ * x);
  if (!(std::abs(corrected) < kLargest)) return false;
  pressure = static_cast<float>(corrected);
  const bool unloading = !weights_.empty() && state[0] > x;
  deviation = static_cast<float>(unloading ? unloading_deviation_(corrected) : loading_deviation_(corrected));
  return true;
}

}  // namespace fsr::calibration
