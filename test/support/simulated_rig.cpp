#include "support/simulated_rig.h"
#include "simulation/settings_text.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace test_support {

using fsr::simulation::SensorChain;

fsr::simulation::SimulationSettings rig(const std::string& more, int rows, int columns) {
  return fsr::simulation::readSimulation(fsr::settings::Settings::fromText(
      "simulation: test\nmatrix: {rows: " + std::to_string(rows) + ", columns: " + std::to_string(columns) +
          "}\neffects:\n  static_curve: {conductance_scatter: 0}\n  converter: {}\n" + more,
      "test.yaml"));
}

fsr::simulation::SimulationSettings straightRig(const std::string& more, int rows, int columns) {
  fsr::simulation::SimulationSettings settings = rig(more, rows, columns);
  for (auto& effect : settings.effects) {
    if (effect.id == "converter") effect.values["full_scale"] = 65535;
    if (effect.id != "static_curve") continue;
    effect.values["exponent"] = 1;
    effect.values["saturation_pressure"] = INFINITY;
    effect.values["conductance"] = kStraightCounts / (65535.0 * 3600.0);
  }
  return settings;
}

fsr::matrix::Surface surfaceOf(const fsr::matrix::Curvature& curvature, std::uint32_t mount) {
  return {"bent", mount, {curvature}, {}};
}

fsr::matrix::Surface cylinder(double radius, std::uint32_t mount) {
  return surfaceOf({1 / radius, 0, 0}, mount);
}

double readAt(SensorChain& chain, double pressure, std::size_t taxel, std::uint64_t scan) {
  chain.read({0, pressure, scan});
  return chain.reading()[taxel];
}

std::vector<Reading> readAlong(SensorChain& chain, const fsr::simulation::PressureProfile& profile,
                               double period, std::size_t taxel, double temperature) {
  const fsr::simulation::PressureCourse course = [&](double time) { return profile.at(time); };
  std::vector<Reading> readings;
  for (std::uint64_t scan = 0; static_cast<double>(scan) * period <= profile.duration(); ++scan) {
    const double time = static_cast<double>(scan) * period;
    fsr::simulation::RigSample moment{time, profile.at(time), scan, temperature, &course};
    readings.push_back({time, moment.pressure, chain.read(moment)[taxel]});
  }
  return readings;
}

const Reading& readingAt(const std::vector<Reading>& readings, double time) {
  return *std::min_element(readings.begin(), readings.end(), [time](const Reading& a, const Reading& b) {
    return std::abs(a.time - time) < std::abs(b.time - time);
  });
}

fsr::simulation::PressureProfile profile(const std::vector<fsr::simulation::PressurePoint>& corners) {
  fsr::simulation::PressureProfile result;
  result.append(corners);
  return result;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double deviation(const std::vector<double>& values) {
  const double centre = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return std::sqrt(sum / double(values.size() - 1));
}

Line fitLine(const std::vector<double>& x, const std::vector<double>& y) {
  const double x_mean = mean(x), y_mean = mean(y);
  double xy = 0, xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - x_mean) * (y[i] - y_mean);
    xx += (x[i] - x_mean) * (x[i] - x_mean);
  }
  return {xy / xx, y_mean - xy / xx * x_mean};
}

}  // namespace test_support
