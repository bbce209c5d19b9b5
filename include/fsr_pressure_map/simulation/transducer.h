#pragma once

#include <cstdint>

namespace fsr::simulation {

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
