#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::calibration {

/// The parts in which errors of a model of the sheet's memory are stated: all readings, loading, unloading,
/// and seven by the time since the chamber last changed its direction.
constexpr std::size_t kHistoryParts = 10;

/// The parts of a reading: all, its direction (where that is unknown, its time twice) and its time.
std::array<std::size_t, 3> historyPartsOf(statistics::LoadDirection direction, double since_reversal);

/// "all readings", "loading", "1 to 3 s since the reversal" ...
std::string historyPartName(std::size_t part);

}  // namespace fsr::calibration
