#include "calibration/stages/temperature/temperature_state.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fsr::calibration {

namespace {

constexpr float kLargestPressure =
    std::numeric_limits<float>::max();  // a map holds no infinite pressure [Pa]

}  // namespace

double temperatureFactor(const TemperatureModel& model, double sheet_temperature) {
  constexpr double kLargest = 2;
  const double factor = 1 + model.sensitivity * (sheet_temperature - model.reference);
  return std::min(std::max(factor, 1 / kLargest), kLargest);
}

TemperatureState::TemperatureState(const TemperatureModel& model)
    : model_(model), unknown_(std::abs(model.sensitivity) * model.spread) {
  if (model.lag > 0) lag_.emplace(model.lag);
}

void TemperatureState::setTemperature(double temperature, double margin) noexcept {
  measured_ = std::isnan(temperature)
                  ? temperature
                  : std::min(std::max(temperature, model_.low - margin), model_.high + margin);
}

void TemperatureState::beginScan(double time) noexcept {
  const double duration = time - time_;
  const bool starts = !lag_ || std::isnan(sheet_) || std::isnan(measured_) || !(duration >= 0);
  sheet_ = starts ? measured_ : lag_->step(before_, measured_, duration, sheet_);
  before_ = measured_;
  time_ = time;
  const bool known = !std::isnan(sheet_);
  factor_ = known ? temperatureFactor(model_, sheet_) : 1;
  unknown_ = known ? 0 : std::abs(model_.sensitivity) * model_.spread;
}

void TemperatureState::correct(std::size_t taxels, float* pressure, float* deviation) const noexcept {
  const auto factor = static_cast<float>(factor_), unknown = static_cast<float>(unknown_);
  if (unknown > 0) {
    for (std::size_t i = 0; i < taxels; ++i) deviation[i] = std::hypot(deviation[i], unknown * pressure[i]);
    return;
  }
  for (std::size_t i = 0; i < taxels; ++i) {
    pressure[i] = std::min(std::max(pressure[i] * factor, -kLargestPressure), kLargestPressure);  // keeps NaN
    deviation[i] *= factor;
  }
}

}  // namespace fsr::calibration
