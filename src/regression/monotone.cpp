#include "regression/monotone.h"

#include <algorithm>
#include <cmath>

#include "regression/grnn/weighted_codes.h"
#include "regression/regressors.h"

namespace fsr::regression {

std::vector<IsotonicBlock> isotonicRegression(const std::vector<double>& values,
                                              const std::vector<double>& weights) {
  std::vector<IsotonicBlock> blocks;
  for (std::size_t i = 0; i < values.size(); ++i) {
    IsotonicBlock block{i, i + 1, values[i], weights[i]};
    while (!blocks.empty() && blocks.back().level >= block.level) {
      const IsotonicBlock& before = blocks.back();
      const double weight = before.weight + block.weight;
      const double level = (before.level * before.weight + block.level * block.weight) / weight;
      block = {before.begin, block.end, level, weight};
      blocks.pop_back();
    }
    blocks.push_back(block);
  }
  return blocks;
}

namespace {

constexpr double kOuterShare =
    1.0 / 16.0;  // share of the range of readings that gives the slope beyond the knots

// Means over the occupied bins of pressure, by ascending pressure, from exact integer sums.
struct BinMeans {
  std::vector<double> pressure;  // [Pa]
  std::vector<double> reading;   // [counts]
  std::vector<double> readings;  // number
};

BinMeans binMeans(const CodeSamples& training) {
  const PressureGrid grid = pressureGrid(training.pressure, kCurveBins);
  std::vector<Int128> pressure(grid.bins, 0);
  std::vector<std::int64_t> reading(grid.bins, 0), readings(grid.bins, 0);
  for (std::size_t i = 0; i < training.size(); ++i) {
    const std::size_t bin = grid.bin(training.pressure[i]);
    pressure[bin] += training.pressure[i];
    reading[bin] += training.code[i];
    ++readings[bin];
  }
  BinMeans means;
  for (std::size_t bin = 0; bin < grid.bins; ++bin) {
    if (readings[bin] == 0) continue;
    const auto number = static_cast<double>(readings[bin]);
    means.pressure.push_back(static_cast<double>(pressure[bin]) / number * kFixedPressureUnit);
    means.reading.push_back(static_cast<double>(reading[bin]) / number);
    means.readings.push_back(number);
  }
  return means;
}

// Sign of the covariance of reading and pressure over the bins, weighted by the number of readings.
bool falls(const BinMeans& means) {
  double all = 0, mean_pressure = 0, mean_reading = 0, covariance = 0;
  for (std::size_t i = 0; i < means.readings.size(); ++i) {
    all += means.readings[i];
    mean_pressure += means.readings[i] * means.pressure[i];
    mean_reading += means.readings[i] * means.reading[i];
  }
  for (std::size_t i = 0; i < means.readings.size(); ++i) {
    covariance += means.readings[i] * (means.pressure[i] - mean_pressure / all) *
                  (means.reading[i] - mean_reading / all);
  }
  return covariance < 0;
}

}  // namespace

// Position of a reading among the knots: between `below` and the next knot, at `share` of the distance; or
// beyond an outer knot, with share 0.
struct MonotoneCurve::Place {
  std::size_t below;
  double share;
  double beyond;  // [counts], negative below the first knot
};

MonotoneCurve::MonotoneCurve(const CodeSamples& training) {
  validate(training);
  BinMeans means = binMeans(training);
  if (falls(means)) {  // in the order of falling pressure, so that readings rise
    std::reverse(means.pressure.begin(), means.pressure.end());
    std::reverse(means.reading.begin(), means.reading.end());
    std::reverse(means.readings.begin(), means.readings.end());
  }
  for (const IsotonicBlock& block : isotonicRegression(means.reading, means.readings)) {
    double pressure = 0;
    for (std::size_t i = block.begin; i < block.end; ++i) {
      pressure += means.pressure[i] * means.readings[i] / block.weight;
    }
    reading_.push_back(block.level);
    pressure_.push_back(pressure);
    readings_.push_back(block.weight);
  }
  const auto [low, high] = std::minmax_element(training.pressure.begin(), training.pressure.end());
  lowest_ = fromFixed(*low);
  highest_ = fromFixed(*high);
  slope_below_ = outerSlope(true);
  slope_above_ = outerSlope(false);
}

// Slope from the outermost knot to the first one that is at least a sixteenth of the range of readings
// inside.
double MonotoneCurve::outerSlope(bool low_end) const {
  if (reading_.size() < 2) return 0.0;
  const double inside = kOuterShare * (reading_.back() - reading_.front());
  const std::size_t outer = low_end ? 0 : reading_.size() - 1;
  std::size_t inner = outer;
  do {
    inner = low_end ? inner + 1 : inner - 1;
  } while (std::abs(reading_[inner] - reading_[outer]) < inside);
  return (pressure_[outer] - pressure_[inner]) / (reading_[outer] - reading_[inner]);
}

MonotoneCurve::Place MonotoneCurve::placeOf(double reading) const {
  if (reading <= reading_.front()) return {0, 0.0, reading - reading_.front()};
  if (reading >= reading_.back()) return {reading_.size() - 1, 0.0, reading - reading_.back()};
  const auto above = static_cast<std::size_t>(std::upper_bound(reading_.begin(), reading_.end(), reading) -
                                              reading_.begin());
  return {above - 1, (reading - reading_[above - 1]) / (reading_[above] - reading_[above - 1]), 0.0};
}

double MonotoneCurve::pressureAt(double reading) const {
  const Place place = placeOf(reading);
  double pressure = pressure_[place.below];
  if (place.share > 0) pressure += place.share * (pressure_[place.below + 1] - pressure);
  pressure += place.beyond * (place.beyond < 0 ? slope_below_ : slope_above_);
  return std::clamp(pressure, lowest_, highest_);
}

double MonotoneCurve::supportAt(double reading) const {
  const Place place = placeOf(reading);
  if (place.share == 0) return readings_[place.below];
  const double below = 1 - place.share, above = place.share;
  return 1.0 / (below * below / readings_[place.below] + above * above / readings_[place.below + 1]);
}

Fit Monotone::fit(const CodeHistogram&) const {
  refuseSums();
}

Fit Monotone::fitSamples(const CodeSamples& training) const {
  const MonotoneCurve curve(training);
  Fit fit{std::vector<double>(training.full_scale + 1u), std::vector<double>(training.full_scale + 1u)};
  for (std::size_t code = 0; code < fit.pressure.size(); ++code) {
    fit.pressure[code] = curve.pressureAt(static_cast<double>(code));
    fit.support[code] = curve.supportAt(static_cast<double>(code));
  }
  return fit;
}

RegressorEntry monotoneEntry() {
  RegressorEntry entry;
  entry.name = "monotone";
  entry.summary = "inverse of a monotone curve of reading over pressure";
  entry.make = [](const RegressorOptions&) -> std::unique_ptr<Regressor> {
    return std::make_unique<Monotone>();
  };
  return entry;
}

}  // namespace fsr::regression
