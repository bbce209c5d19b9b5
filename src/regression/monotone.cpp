#include "regression/monotone.h"

#include <algorithm>
#include <cmath>

#include "regression/isotonic.h"
#include "regression/pressure_grid.h"
#include "regression/regressors.h"

namespace fsr::regression {

namespace {

constexpr double kOuterShare =
    1.0 / 16.0;  // share of the range of readings that gives the slope beyond the knots
constexpr double kPriorReadings = 30.0;  // weight of the scatter of all knots in that of one

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
  measureScatter(training);
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

// The reading at a pressure, constant beyond the outer knots.
double MonotoneCurve::readingAt(double pressure) const {
  const bool falling = pressure_.front() > pressure_.back();
  const auto before = [falling](double a, double b) { return falling ? a > b : a < b; };
  const auto found = std::lower_bound(pressure_.begin(), pressure_.end(), pressure, before);
  if (found == pressure_.begin()) return reading_.front();
  if (found == pressure_.end()) return reading_.back();
  const auto above = static_cast<std::size_t>(found - pressure_.begin());
  const double share = (pressure - pressure_[above - 1]) / (pressure_[above] - pressure_[above - 1]);
  return reading_[above - 1] + share * (reading_[above] - reading_[above - 1]);
}

// Standard deviation of the readings of each knot from the curve.
void MonotoneCurve::measureScatter(const CodeSamples& training) {
  std::vector<double> squares(reading_.size(), 0.0), number(reading_.size(), 0.0);
  double all = 0;
  for (std::size_t i = 0; i < training.size(); ++i) {
    const double expected = readingAt(fromFixed(training.pressure[i]));
    const double error = training.code[i] - expected;
    const Place place = placeOf(expected);
    const std::size_t knot = place.share > 0.5 ? place.below + 1 : place.below;
    squares[knot] += error * error;
    number[knot] += 1;
    all += error * error;
  }
  const double pooled = all / static_cast<double>(training.size());
  for (std::size_t knot = 0; knot < reading_.size(); ++knot) {
    const double square = (squares[knot] + kPriorReadings * pooled) / (number[knot] + kPriorReadings);
    scatter_.push_back(std::sqrt(square));
  }
}

double MonotoneCurve::scatterAt(double reading) const {
  const Place place = placeOf(reading);
  const double below = scatter_[place.below];
  return place.share > 0 ? below + place.share * (scatter_[place.below + 1] - below) : below;
}

double MonotoneCurve::deviationAt(double reading) const {
  const double scatter = scatterAt(reading);
  return 0.5 * std::abs(pressureAt(reading + scatter) - pressureAt(reading - scatter));
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
