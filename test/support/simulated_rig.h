#pragma once

#include <string>
#include <vector>

#include "simulation/pressure_profile.h"
#include "simulation/sensor_chain.h"

namespace test_support {

/// A rig with the usual static curve without scatter and the usual converter. `more` is YAML of further
/// effects, indented.
fsr::simulation::SimulationSettings rig(const std::string& more = "", int rows = 2, int columns = 3);

/// The same with a linear sensor, 60,000 counts at 620 kPa on a converter of 16 bits: shares of the reading
/// equal shares of the pressure.
fsr::simulation::SimulationSettings straightRig(const std::string& more = "", int rows = 1, int columns = 2);
constexpr double kStraightCounts = 60000;  // at kStraightSpan
constexpr double kStraightSpan = 620e3;    // [Pa]

fsr::matrix::Surface surfaceOf(const fsr::matrix::Curvature& curvature, std::uint32_t mount = 1);
fsr::matrix::Surface cylinder(double radius, std::uint32_t mount = 1);

/// Unrounded reading at one pressure [counts].
double readAt(fsr::simulation::SensorChain& chain, double pressure, std::size_t taxel = 0,
              std::uint64_t scan = 0);

/// One scan of a series.
struct Reading {
  double time;           // [s]
  double pressure;       // of the chamber [Pa]
  std::uint16_t counts;  // of the taxel
};

/// The scans of the sensor chain during a pressure profile, one every `period` [s] from time 0.
std::vector<Reading> readAlong(fsr::simulation::SensorChain& chain,
                               const fsr::simulation::PressureProfile& profile, double period,
                               std::size_t taxel = 0, double temperature = fsr::simulation::kRoomTemperature);

/// The reading at the time nearest to `time` [s].
const Reading& readingAt(const std::vector<Reading>& readings, double time);

/// A piecewise linear profile through corners (time [s], pressure [Pa]).
fsr::simulation::PressureProfile profile(const std::vector<fsr::simulation::PressurePoint>& corners);

double mean(const std::vector<double>& values);
double deviation(const std::vector<double>& values);
/// Least-squares line: slope and value at 0.
struct Line {
  double slope, intercept;
};
Line fitLine(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace test_support
