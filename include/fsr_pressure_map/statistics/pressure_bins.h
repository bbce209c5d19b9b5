#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace fsr::statistics {

/// Lower edges of the bins in which errors and coverage are stated, gauge [Pa]. The first bin also includes
/// lower pressures, because the readings of a vented chamber scatter around zero. The last has no upper edge.
constexpr std::array<double, 5> kPressureBinEdges = {0.0, 50e3, 100e3, 200e3, 400e3};
constexpr std::size_t kPressureBins = kPressureBinEdges.size();

/// Number of the bin that contains `pressure` [Pa].
std::size_t pressureBin(double pressure);

/// "0-50", ..., "400+" [kPa, gauge].
std::string pressureBinName(std::size_t bin);

/// Whether the chamber was being loaded or unloaded when a scan was taken. A dwell belongs to the direction
/// before it.
enum class LoadDirection : std::uint8_t {
  kNone,       ///< the pressure never changes
  kLoading,    ///< from a cycle's valley to its peak
  kUnloading,  ///< from the peak to the next valley
};

}  // namespace fsr::statistics
