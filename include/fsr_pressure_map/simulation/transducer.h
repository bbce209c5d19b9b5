#pragma once

#include <cstdint>

namespace fsr::simulation {

/// The chamber's own pressure transducer behind its converter: counts on a straight line of gauge
/// pressure. The defaults are the paper's Omega PX309 (-103 to 1034 kPa, 0 to 5 V) read by a 14-bit
/// USB-6001 at +-10 V: 4,096 steps of 0.28 kPa. (That the output spans 5 V is inferred from the step.)
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
