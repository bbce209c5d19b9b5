#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

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

/// Step or ramp to a pressure, then hold it.
struct HoldPart {
  double pressure = 0;  ///< gauge [Pa]
  double rate = 17e3;   ///< [Pa/s]
  double duration = 0;  ///< [s]
};

/// Minor loops. They begin and end at `low`.
struct LoopsPart {
  double low = 0;      ///< gauge [Pa]
  double high = 0;     ///< gauge [Pa]
  double rate = 17e3;  ///< [Pa/s]
  unsigned loops = 1;
};

/// Vent to zero gauge pressure, then wait.
struct RestPart {
  double rate = 17e3;   ///< [Pa/s]
  double duration = 0;  ///< [s]
};

/// Cycles begin and end at rest.
using ProgramPart = std::variant<ChamberProtocol, HoldPart, LoopsPart, RestPart>;

/// What the chamber does, part after part. Each part starts at the pressure where the one before ended.
using ChamberProgram = std::vector<ProgramPart>;

/// Temperature of the room at one time.
struct TemperaturePoint {
  double time = 0;         ///< rig time [s]
  double temperature = 0;  ///< [degree Celsius]
};

/// Temperature of the room and of the gas round the matrix.
struct ChamberClimate {
  /// Of the room, by ascending time: linear between the points, constant outside them. Empty = 23 degree
  /// Celsius.
  std::vector<TemperaturePoint> room;
  /// Compressed gas gets warmer and cools down at the walls: increase of the temperature with the pressure
  /// [K/Pa], and time constant of the cooling [s]. Off by default; nobody has published either number for
  /// such a chamber.
  double heating = 0;
  double cooling = 20;
};

/// The pressure transducer of the chamber with its converter: counts are a linear function of gauge pressure.
/// The defaults are those of Ahmadizadeh and Menon 2019 (doi:10.3390/s19245519): an Omega PX309 (-103 to 1034
/// kPa, 0 to 5 V) read by a 14-bit USB-6001 at +-10 V, which gives 4,096 steps of 0.28 kPa. (The output range
/// of 5 V is inferred from the step.)
struct Transducer {
  double low = -103e3;   ///< gauge pressure at 0 counts [Pa]
  double high = 1034e3;  ///< gauge pressure at `full_counts` [Pa]
  std::int32_t full_counts = 4096;

  double step() const { return (high - low) / full_counts; }  ///< [Pa] a count
  /// Nearest count, clipped to 0 .. full_counts.
  std::int32_t counts(double gauge_pressure) const;
  double gaugePressure(std::int32_t counts) const { return low + counts * step(); }
};

}  // namespace fsr::simulation
