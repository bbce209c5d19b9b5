#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace fsr::statistics {

/// Lower edges of the bins in which errors and coverage are stated, gauge [Pa]. The first bin takes
/// what lies below it too (a vented chamber scatters around zero), the last has no upper end.
constexpr std::array<double, 5> kPressureBinEdges = {0.0, 50e3, 100e3, 200e3, 400e3};
constexpr std::size_t kPressureBins = kPressureBinEdges.size();

/// Number of the bin that holds `pressure` [Pa].
std::size_t pressureBin(double pressure);

/// "0-50", ..., "400+" [kPa, gauge].
std::string pressureBinName(std::size_t bin);

/// Which way the chamber was going when a scan was taken; a dwell belongs to what came before it.
enum class LoadDirection : std::uint8_t {
  kNone,       ///< the pressure never changes
  kLoading,    ///< from a cycle's valley to its peak
  kUnloading,  ///< from the peak back
};

}  // namespace fsr::statistics
