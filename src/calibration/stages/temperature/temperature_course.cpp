#include "calibration/stages/temperature/temperature_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "fsr_pressure_map/calibration/calibrator.h"
#include "rheology/memory.h"

namespace fsr::calibration {

namespace {

// A sheet of film follows its support: seconds on thin film in moving air, minutes on a limb or a cylinder
// [s].
constexpr double kLags[] = {0, 30, 120, 480};
constexpr double kShareOfRecording = 1.0 / 3;  // the longest lag

bool counts(const dataset::Sections& sections, std::size_t scan) {
  return sections.section[scan] != dataset::kNoSection;
}

struct Range {
  double low = INFINITY, high = -INFINITY;
  void include(double value) { low = std::min(low, value), high = std::max(high, value); }
};

}  // namespace

std::vector<double> sheetTemperature(const dataset::Recording& recording, double lag) {
  std::vector<double> temperature = recording.temperature;
  if (lag == 0) return temperature;
  const rheology::ExponentialMemory sheet(lag);
  for (std::size_t i = 1; i < temperature.size(); ++i) {
    const double duration = std::max(0.0, recording.time[i] - recording.time[i - 1]);
    temperature[i] =
        sheet.step(recording.temperature[i - 1], recording.temperature[i], duration, temperature[i - 1]);
  }
  return temperature;
}

std::vector<double> cycleMeans(const std::vector<double>& values, const dataset::Recording& recording,
                               const dataset::Sections& sections) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<double, double>>
      sums;  // by condition and cycle
  const auto cycleOf = [&](std::size_t i) { return std::pair(recording.condition[i], sections.cycle[i]); };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!counts(sections, i)) continue;
    auto& sum = sums[cycleOf(i)];
    sum.first += values[i];
    sum.second += 1;
  }
  std::vector<double> means(values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!counts(sections, i)) continue;
    const auto& sum = sums[cycleOf(i)];
    means[i] = sum.first / sum.second;
  }
  return means;
}

bool haveTemperature(const std::vector<dataset::Recording>& recordings) {
  return std::all_of(recordings.begin(), recordings.end(), [](const dataset::Recording& recording) {
    const auto& values = recording.temperature;
    return values.size() == recording.scans() &&
           std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  });
}

TemperatureGrid temperatureGrid(const std::vector<dataset::Recording>& recordings,
                                const std::vector<dataset::Sections>& sections) {
  if (!haveTemperature(recordings)) return {};
  Range measured, of_cycles;
  double sum = 0, scans = 0, longest = 0;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const dataset::Recording& recording = recordings[r];
    if (recording.scans() == 0) continue;
    longest = std::max(longest, recording.time.back() - recording.time.front());
    const std::vector<double> means = cycleMeans(recording.temperature, recording, sections[r]);
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (!counts(sections[r], i)) continue;
      measured.include(recording.temperature[i]);
      of_cycles.include(means[i]);
      sum += recording.temperature[i];
      scans += 1;
    }
  }
  if (!(of_cycles.high - of_cycles.low > kLeastTemperatureSpan)) return {};
  TemperatureGrid grid{{}, sum / scans, measured.low, measured.high};
  for (const double lag : kLags) {
    if (lag <= kShareOfRecording * longest) grid.lags.push_back(lag);
  }
  return grid;
}

void setTemperatureOf(const dataset::Recording& recording, std::size_t scan, const Calibration& calibration,
                      Calibrator& calibrator) {
  if (recording.temperature.empty()) return;
  const TrainedInterval& trained = calibration.trained.temperature;
  calibrator.setTemperature(recording.temperature[scan], trained.low, trained.high);
}

std::vector<dataset::Recording> atReference(std::vector<dataset::Recording> recordings,
                                            const TemperatureModel& model) {
  for (dataset::Recording& recording : recordings) {
    const std::vector<double> sheet = sheetTemperature(recording, model.lag);
    for (std::size_t i = 0; i < recording.scans(); ++i)
      recording.pressure[i] /= temperatureFactor(model, sheet[i]);
  }
  return recordings;
}

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
