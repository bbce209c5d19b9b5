#include "discrepancy/prove/costs_in_use.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "simulation/sensor_chain.h"

namespace fsr::discrepancy {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRamp = 17e3;     // speed of the ramps in the paper [Pa/s]
constexpr double kStance = 0.6;    // time with the foot on the ground, and time with it off the ground [s]
constexpr double kSteps = 10;      // by the last step the sheet has adapted to walking
constexpr double kStanding = 600;  // duration of standing [s]
constexpr double kOnto = 1;        // time from no load to standing [s]
constexpr double kLoaded = 0.1;    // share of the peak; errors below it do not count
constexpr double kBeyond = 1.3;    // curves are extrapolated linearly to this factor of the highest pressure
constexpr std::size_t kPoints = 500;  // points of a curve

// A course of pressure, and the part of it in which errors count.
struct Situation {
  const char* name;
  double peak;       // [Pa]
  double from, end;  // [s]
  double step;       // [s]
  simulation::PressureCourse pressure;
};

std::vector<Situation> situations(double highest) {
  const double up = highest / kRamp, half = highest / 2;
  const simulation::PressureCourse ramp = [=](double t) {
    const double phase = t < 0 ? 0 : std::fmod(t, 2 * up);
    return kRamp * std::min(phase, 2 * up - phase);
  };
  const simulation::PressureCourse steps = [=](double t) {
    const double phase = t < 0 ? 0 : std::fmod(t, 2 * kStance);
    return phase < kStance ? half * std::sin(kPi * phase / kStance) : 0;
  };
  const simulation::PressureCourse standing = [=](double t) {
    return half * std::clamp(t / kOnto, 0.0, 1.0);
  };
  return {{"ramp", highest, 2 * up, 4 * up, up / 100, ramp},
          {"stance", half, 2 * kStance * (kSteps - 1), 2 * kStance * (kSteps - 1) + kStance, 0.02, steps},
          {"standing", half, kOnto, kOnto + kStanding, 0.5, standing}};
}

matrix::Surface surfaceOf(const Measured& measured, std::size_t curvature_class) {
  matrix::Surface surface;
  for (const Visit& visit : measured.visits) {
    if (visit.curvature_class == curvature_class) surface = visit.surface;
  }
  surface.curvature.resize(1);
  surface.deviation.clear();
  return surface;
}

// The recordings as they were made, without the subtraction of effects.
Measured asRecorded(const Measured& measured) {
  Measured plain = measured;
  plain.load.clear();
  plain.gain.clear();
  plain.added.clear();
  return plain;
}

// A sheet with the static curves that were fitted to it in the chamber.
class CalibratedSheet {
 public:
  CalibratedSheet(const Measured& measured, const simulation::SimulationSettings& settings)
      : measured_(asRecorded(measured)),
        settings_(representative(settings)),
        fit_(measured_, CurvePer::kClass, driven(measured_, settings, true).reading) {}

  // Error of the pressure that the sheet reads at each step of the situation [Pa]; 0 where it does not count.
  std::vector<double> errors(const Situation& situation, std::size_t curvature_class) const;

 private:
  // Readings of the class's curve at kPoints pressures from 0 to `highest`, made non-decreasing.
  std::vector<double> curveOf(std::size_t curvature_class, double highest) const;

  const Measured measured_;
  const simulation::SimulationSettings settings_;
  const StaticFit fit_;
};

std::vector<double> CalibratedSheet::curveOf(std::size_t curvature_class, double highest) const {
  std::size_t sample = 0;
  while (measured_.classOf(sample) != curvature_class) ++sample;
  std::vector<double> curve;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const double reading = fit_.curveAt(sample, highest * static_cast<double>(k) / (kPoints - 1));
    curve.push_back(curve.empty() ? reading : std::max(reading, curve.back()));
  }
  return curve;
}

// Pressure at which a curve has this reading, limited to the ends of the curve [Pa].
double pressureOf(const std::vector<double>& curve, double highest, double reading) {
  const auto above = std::upper_bound(curve.begin(), curve.end(), reading);
  if (above == curve.begin()) return 0;
  if (above == curve.end()) return highest;
  const double share = (reading - *(above - 1)) / (*above - *(above - 1));
  return highest * (static_cast<double>(above - curve.begin() - 1) + share) / (kPoints - 1);
}

std::vector<double> CalibratedSheet::errors(const Situation& situation, std::size_t curvature_class) const {
  simulation::SensorChain chain(settings_);
  chain.mount(surfaceOf(measured_, curvature_class));
  const double full_scale = settings_.fullScale();
  const double highest = kBeyond * *std::max_element(measured_.pressure.begin(), measured_.pressure.end());
  const std::vector<double> curve = curveOf(curvature_class, highest);
  std::vector<double> errors;
  simulation::RigSample now;
  now.course = &situation.pressure;
  for (now.time = 0; now.time <= situation.end; now.time += situation.step, ++now.scan) {
    now.pressure = situation.pressure(now.time);
    chain.read(now);
    const bool counts = now.time >= situation.from && now.pressure >= kLoaded * situation.peak;
    const double read = pressureOf(curve, highest, chain.reading()[0] / full_scale);
    errors.push_back(counts ? read - now.pressure : 0);
  }
  return errors;
}

double largestApart(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

std::vector<GapInUse> costsInUse(const Measured& measured, const simulation::SimulationSettings& without,
                                 const simulation::SimulationSettings& with, double closed) {
  const double highest = *std::max_element(measured.pressure.begin(), measured.pressure.end());
  const double left = std::sqrt(std::clamp(1 - closed, 0.0, 1.0));  // NaN if `closed` is not known
  const CalibratedSheet before(measured, with), neutral(measured, without);
  std::vector<GapInUse> costs;
  for (const Situation& situation : situations(highest)) {
    double largest = 0;
    for (std::size_t c = 0; c < measured.classes.size(); ++c) {
      largest = std::max(largest, largestApart(before.errors(situation, c), neutral.errors(situation, c)));
    }
    costs.push_back({situation.name, largest, left * largest});
  }
  return costs;
}

}  // namespace fsr::discrepancy
