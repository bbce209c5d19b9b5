#pragma once

#include <string>

namespace fsr::simulation {

/// Highest gauge pressure that the chamber is built for [Pa]. Settings above it are refused.
constexpr double kChamberRating = 793e3;

/// Cycles of filling and venting: rest, fill, dwell at the peak, vent. The defaults are those of Ahmadizadeh
/// and Menon 2019 (doi:10.3390/s19245519): 620 kPa, ten cycles of 75 s, 7,500 scans at 10 Hz.
struct ChamberProtocol {
  double peak = 620e3;      ///< gauge [Pa]
  double fill_rate = 17e3;  ///< [Pa/s]
  double vent_rate = 17e3;  ///< [Pa/s]
  double dwell_peak = 1.0;  ///< [s]
  double dwell_rest = 1.0;  ///< before each filling [s]
  unsigned cycles = 10;     ///< 0 = for ever
};

/// Throws InputError that names the field that is out of range. Messages use `origin` as the name of the
/// file.
void validate(const ChamberProtocol& protocol, const std::string& origin);

/// Length of one cycle [s].
double cycleDuration(const ChamberProtocol& protocol);

}  // namespace fsr::simulation
