#include "calibration/stages/memory/history_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "fsr_pressure_map/calibration/history.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr std::array<const char*, 4> kNames = {"none", "plays", "memories", "both"};

}  // namespace

std::string historyName(HistoryFamily family) {
  return kNames.at(static_cast<std::size_t>(family));
}

HistoryFamily historyFromName(const std::string& name) {
  const auto place = std::find(kNames.begin(), kNames.end(), name);
  if (place == kNames.end())
    throw settings::InputError("history \"" + name + "\" is unknown; use none, plays, memories or both");
  return static_cast<HistoryFamily>(place - kNames.begin());
}

namespace {

constexpr double kLargest = 1e30;  // answer [Pa]; a map holds no infinite pressure
constexpr double kBeyond = 0.8;    // see withOpen()

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

std::vector<double> limitsOf(const HistoryModel& model, const std::vector<double>& limits, double none) {
  return limits.empty() ? std::vector<double>(model.knot.size(), none) : limits;
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
    each_[k] = std::abs(each_[k]) * (k < plays ? 1 : spreads[k - plays]);
    whole += each_[k] * (k < plays ? radii[k] : 1);
  }
  if (whole > 0) per_whole_ = 1 / whole;
}

double withOpen(double settled, double open) {
  return std::max(std::sqrt(settled * settled + open * open), open + kBeyond * settled);
}

double withoutOpen(double error, double open) {
  if (error <= open) return 0;
  return std::min(std::sqrt(error * error - open * open), (error - open) / kBeyond);
}

HistoryState::HistoryState(const HistoryModel& model, std::size_t taxels)
    : operators_(model.radius, model.time_constant, model.knot.back()),
      weights_(weightsOf(model)),
      correction_(model.knot, model.correction),
      least_change_(model.knot, limitsOf(model, model.least_change, -kLargest)),
      largest_change_(model.knot, limitsOf(model, model.largest_change, kLargest)),
      loading_deviation_(model.deviation_knot, model.loading_deviation),
      unloading_deviation_(model.deviation_knot, model.unloading_deviation),
      open_deviation_(weights_, model.radius, spreadsOf(model)),
      steps_(operators_.memories()),
      spell_steps_(operators_.memories()),
      taxels_(taxels),
      states_(taxels * operators_.size()),
      open_(taxels * operators_.size()) {
  for (const double weight : weights_) weight_sum_ += weight;
}

void HistoryState::forget() noexcept {
  setKnown(HistoryTaxel::Known::kNothing);
}

void HistoryState::rest() noexcept {
  setKnown(HistoryTaxel::Known::kRest);
}

void HistoryState::setKnown(HistoryTaxel::Known known) noexcept {
  for (HistoryTaxel& taxel : taxels_) taxel.known = known;
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
const HistoryOperators::Step* HistoryState::stepsOfSpell(double duration) noexcept {
  if (duration != spell_) operators_.stepsOver(duration, spell_steps_.data());
  spell_ = duration;
  return spell_steps_.data();
}

void HistoryState::atLeast(std::size_t taxel, double pressure) noexcept {
  if (!std::isfinite(pressure)) return;
  taxels_[taxel].limit = pressure;
  taxels_[taxel].limited_at = time_;
}

HistoryAnswer HistoryState::correct(std::size_t taxel, bool frozen, float& pressure,
                                    float& deviation) noexcept {
  const double x = static_cast<double>(pressure);
  HistoryTaxel& own = taxels_[taxel];
  if (frozen || !std::isfinite(x)) {
    // The next reading may be one under load.
    if (own.known == HistoryTaxel::Known::kRest) own.known = HistoryTaxel::Known::kNothing;
    return HistoryAnswer::kNoReading;
  }
  double* const state = states_.data() + taxel * operators_.size();
  double* const open = open_.data() + taxel * operators_.size();
  operators_.meet(
      own, x, time_, before_, steps_.data(), [this](double spell) { return stepsOfSpell(spell); }, state,
      open);
  const double unknown = own.open ? open_deviation_(open) : 0;
  double sum = 0;
  for (std::size_t k = 0; k < weights_.size(); ++k) sum += weights_[k] * state[k];
  const EvenPlace at = correction_.placeOf(x);
  const double change = correction_.at(at) * open_deviation_.knownShare(unknown) + (sum - weight_sum_ * x);
  const double corrected = x + std::min(std::max(change, least_change_.at(at)), largest_change_.at(at));
  if (!(std::abs(corrected) < kLargest)) return HistoryAnswer::kNoReading;
  pressure = static_cast<float>(corrected);
  const bool unloading = !weights_.empty() && state[0] > x;
  const double settled = unloading ? unloading_deviation_(corrected) : loading_deviation_(corrected);
  const double stated = own.open ? withOpen(settled, unknown) : settled;
  deviation = static_cast<float>(stated);
  return stated <= 2 * settled ? HistoryAnswer::kSettled : HistoryAnswer::kOpen;
}

}  // namespace fsr::calibration
