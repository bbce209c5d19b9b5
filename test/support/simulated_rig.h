#pragma once

#include <string>
#include <vector>

#include "simulation/pressure_profile.h"
#include "simulation/sensor_chain.h"

namespace test_support {

/// A rig of the usual static curve without scatter, the usual converter and `more`, indented YAML of
/// effects.
fsr::simulation::SimulationSettings rig(const std::string& more = "", int rows = 2, int columns = 3);

/// The same with a straight sensor: 60,000 counts at 620 kPa on a converter of 16 bits, so that shares of
/// full scale and of pressure are the same.
fsr::simulation::SimulationSettings straightRig(const std::string& more = "", int rows = 1, int columns = 2);
constexpr double kStraightCounts = 60000;  // at kStraightSpan
constexpr double kStraightSpan = 620e3;    // [Pa]

fsr::matrix::Surface surfaceOf(const fsr::matrix::Curvature& curvature, std::uint32_t mount = 1);
fsr::matrix::Surface cylinder(double radius, std::uint32_t mount = 1);

/// Unrounded reading at one pressure.
double readAt(fsr::simulation::SensorChain& chain, double pressure, std::size_t taxel = 0,
              std::uint64_t scan = 0);

/// One scan of a course that is read scan by scan.
struct Reading {
  double time;           // [s]
  double pressure;       // of the chamber [Pa]
  std::uint16_t counts;  // of the taxel
};

/// What comes out when the chain goes through a profile, a scan every `period` [s] from time 0.
std::vector<Reading> readAlong(fsr::simulation::SensorChain& chain,
                               const fsr::simulation::PressureProfile& profile, double period,
                               std::size_t taxel = 0, double temperature = fsr::simulation::kRoomTemperature);

/// The reading whose time is nearest to `time`.
const Reading& readingAt(const std::vector<Reading>& readings, double time);

/// A profile from corners (time [s], pressure [Pa]).
fsr::simulation::PressureProfile profile(const std::vector<fsr::simulation::PressurePoint>& corners);

double mean(const std::vector<double>& values);
double deviation(const std::vector<double>& values);
/// Slope and value at 0 of the straight line of least squares.
struct Line {
  double slope, intercept;
};
Line fitLine(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace test_support
