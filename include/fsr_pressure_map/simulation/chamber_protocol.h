#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/settings/settings.h"
#include "fsr_pressure_map/simulation/pressure_profile.h"

namespace fsr::simulation {

/// Gauge pressure that the chamber is built for [Pa]; nothing may ask for more.
constexpr double kChamberRating = 793e3;

/// Cycles of filling and venting: rest, fill, dwell at the peak, vent. The defaults are those of the
/// paper: 620 kPa, ten cycles of 75 s, 7,500 scans at 10 Hz.
struct ChamberProtocol {
  double peak = 620e3;      ///< gauge [Pa]
  double fill_rate = 17e3;  ///< [Pa/s]
  double vent_rate = 17e3;  ///< [Pa/s]
  double dwell_peak = 1.0;  ///< [s]
  double dwell_rest = 1.0;  ///< before each filling [s]
  unsigned cycles = 10;     ///< 0 = for ever
};

/// Reads the mapping `peak`, `rate` (both ways) or `fill_rate` and `vent_rate`, `dwell_peak`,
/// `dwell_rest`, `cycles`; what is missing keeps the value of `defaults`. Throws InputError.
ChamberProtocol readChamberProtocol(const settings::Settings& settings, const ChamberProtocol& defaults = {});

/// Throws InputError that names what is out of range; `origin` stands where messages name the file.
void validate(const ChamberProtocol& protocol, const std::string& origin);

/// The protocol as a YAML mapping on one line, as readChamberProtocol() reads it.
std::string protocolText(const ChamberProtocol& protocol);

/// Length of one cycle [s].
double cycleDuration(const ChamberProtocol& protocol);

/// One cycle, from its start.
std::vector<PressurePoint> cyclePoints(const ChamberProtocol& protocol);
PressureProfile pressureProfile(const ChamberProtocol& protocol);

/// Straight from `pressure` down to 0 at the protocol's venting rate.
PressureProfile ventingProfile(const ChamberProtocol& protocol, double pressure);

}  // namespace fsr::simulation
