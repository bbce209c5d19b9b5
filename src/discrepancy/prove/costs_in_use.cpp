#include "discrepancy/prove/costs_in_use.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "simulation/sensor_chain.h"
#include "statistics/median.h"

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
constexpr double kTellingSlope = 0.05;  // of the usual one: below it a reading tells nothing of the pressure
constexpr std::size_t kPoints = 500;    // points of a curve

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

// Readings of a static curve at kPoints pressures from 0 to `highest`, never falling.
struct Curve {
  double highest = 0;  // [Pa]
  double usual = 0;    // slope from point to point
  std::vector<double> reading;

  double step() const { return highest / (kPoints - 1); }
  // Pressure at which the curve has this reading [Pa]. NaN beyond its ends: a map gives no pressure there.
  double pressureOf(double value) const {
    const auto above = std::upper_bound(reading.begin(), reading.end(), value);
    if (above == reading.begin() || above == reading.end()) return NAN;
    const double share = (value - *(above - 1)) / (*above - *(above - 1));
    return step() * (static_cast<double>(above - reading.begin() - 1) + share);
  }
  // Whether the curve is so flat at this pressure that its reading tells nothing.
  bool flatAt(double pressure) const {
    const auto at = std::min(kPoints - 2, static_cast<std::size_t>(std::max(0.0, pressure / step())));
    return reading[at + 1] - reading[at] < kTellingSlope * usual;
  }
};

// A sheet with the static curves that were fitted to it in the chamber.
class CalibratedSheet {
 public:
  CalibratedSheet(const Measured& measured, const simulation::SimulationSettings& settings)
      : measured_(asRecorded(measured)),
        settings_(representative(settings)),
        fit_(measured_, CurvePer::kClass, driven(measured_, settings, true).reading) {}

  // Error of the pressure that the sheet reads at each step of the situation [Pa]; NaN where it does not
  // count. `highest`: pressure that the class reached in the recordings [Pa].
  std::vector<double> errors(const Situation& situation, std::size_t curvature_class, double highest) const;

 private:
  Curve curveOf(std::size_t curvature_class, double highest) const;

  const Measured measured_;
  const simulation::SimulationSettings settings_;
  const StaticFit fit_;
};

Curve CalibratedSheet::curveOf(std::size_t curvature_class, double highest) const {
  std::size_t sample = 0;
  while (measured_.classOf(sample) != curvature_class) ++sample;
  Curve curve;
  curve.highest = kBeyond * highest;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const double reading = fit_.curveAt(sample, curve.step() * static_cast<double>(k));
    curve.reading.push_back(k == 0 ? reading : std::max(reading, curve.reading.back()));
  }
  std::vector<double> slopes;
  for (std::size_t k = 1; k < kPoints; ++k) slopes.push_back(curve.reading[k] - curve.reading[k - 1]);
  curve.usual = statistics::upperMedian(slopes);
  return curve;
}

std::vector<double> CalibratedSheet::errors(const Situation& situation, std::size_t curvature_class,
                                            double highest) const {
  simulation::SensorChain chain(settings_);
  chain.mount(surfaceOf(measured_, curvature_class));
  const double full_scale = settings_.fullScale();
  const Curve curve = curveOf(curvature_class, highest);
  std::vector<double> errors;
  simulation::RigSample now;
  now.course = &situation.pressure;
  for (now.time = 0; now.time <= situation.end; now.time += situation.step, ++now.scan) {
    now.pressure = situation.pressure(now.time);
    chain.read(now);
    const bool counts =
        now.time >= situation.from && now.pressure >= kLoaded * situation.peak && !curve.flatAt(now.pressure);
    errors.push_back(counts ? curve.pressureOf(chain.reading()[0] / full_scale) - now.pressure : NAN);
  }
  return errors;
}

// Largest difference where both count.
double largestApart(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double apart = std::abs(a[i] - b[i]);
    if (apart > largest) largest = apart;
  }
  return largest;
}

double highestOn(const Measured& measured, std::size_t curvature_class) {
  double highest = 0;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (measured.classOf(i) == curvature_class) highest = std::max(highest, measured.pressure[i]);
  }
  return highest;
}

}  // namespace

std::vector<GapInUse> costsInUse(const Measured& measured, const simulation::SimulationSettings& without,
                                 const simulation::SimulationSettings& with, double closed) {
  const double left = std::sqrt(std::clamp(1 - closed, 0.0, 1.0));  // NaN if `closed` is not known
  const CalibratedSheet before(measured, with), neutral(measured, without);
  std::vector<GapInUse> costs;
  for (std::size_t c = 0; c < measured.classes.size(); ++c) {
    const double highest = highestOn(measured, c);
    const std::vector<Situation> all = situations(highest);
    costs.resize(all.size());
    for (std::size_t s = 0; s < all.size(); ++s) {
      const double apart =
          largestApart(before.errors(all[s], c, highest), neutral.errors(all[s], c, highest));
      costs[s].situation = all[s].name;
      costs[s].before = std::max(costs[s].before, apart);
    }
  }
  for (GapInUse& cost : costs) cost.after = left * cost.before;
  return costs;
}

}  // namespace fsr::discrepancy
