#pragma once

#include <cstdint>
#include <vector>

#include "dataset/protocols.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// Below this share of the fastest rate the chamber holds its pressure.
constexpr double kStill = 0.05;
/// Below this share of the highest pressure the sheet is unloaded.
constexpr double kLoaded = 0.1;
/// Shorter dwells count as corners [s].
constexpr double kLeastDwell = 2;

/// Slope of the chamber's pressure at each scan: a straight line through the scans of two seconds [Pa/s]. No
/// window reaches beyond the surface on which the scan was taken. Pressures must be finite.
std::vector<double> pressureRates(const Recording& recording);

/// 1 for each scan at which the loaded chamber holds its pressure, for kLeastDwell or longer. None
/// where a pressure is not finite.
std::vector<std::uint8_t> dwellsOf(const Recording& recording);

/// How the chamber was driven, one entry for each kind of cycle. Cycles are of one kind where speed, dwell
/// and peak differ by no more than kOtherSpeed, kOtherDwell and kOtherPeak. Pressures must be finite.
std::vector<CycleCourse> pacesOf(const std::vector<Recording>& recordings);

/// Whether more than half of the cycles are of one of these kinds.
bool havePaces(const std::vector<Recording>& recordings, const std::vector<CycleCourse>& paces);

}  // namespace fsr::dataset
