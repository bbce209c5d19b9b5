#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dataset/sections.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// How the chamber was driven in one cycle.
struct CycleCourse {
  double speed = 0;  ///< median speed of the ramps [Pa/s]
  double dwell = 0;  ///< time at constant pressure under load [s]; shorter dwells than 2 s count as 2 s
  double peak = 0;   ///< [Pa]
};

/// The largest values of all cycles, against which a ramp and a load are judged.
struct CourseScale {
  double fastest = 0;  ///< largest |rate of pressure| [Pa/s]
  double highest = 0;  ///< largest pressure [Pa]
};

/// The course of one cycle from `scans` values each of time [s], pressure [Pa] and its rate [Pa/s].
CycleCourse courseOf(const double* time, const double* pressure, const double* rate, std::size_t scans,
                     const CourseScale& scale);

/// A feature that is larger by more than this factor belongs to another protocol.
constexpr double kOtherSpeed = 1.5;
constexpr double kOtherDwell = 3;
constexpr double kOtherPeak = 1.3;

/// Sorts the cycles by one feature and divides them where the feature jumps by more than `factor`. Features
/// of 0 belong to no group. The members of a group ascend.
std::vector<std::vector<std::size_t>> groupsByJump(const std::vector<double>& feature, double factor);

/// Protocols of several recordings: groups of cycles that differ in pace, dwell or peak.
struct Protocols {
  /// A scan that belongs to a group that is too small to be left out alone.
  static constexpr std::uint32_t kOther = 0xffffffff;

  std::vector<std::string> names;                   ///< e.g. "ramps of 17 kPa/s, dwells of 2 s"
  std::vector<std::vector<std::uint32_t>> of_scan;  ///< [recordings][scans], index into `names` or kOther
  /// The number of the scan's part of its protocol. Parts 2 n and 2 n + 1 are loading and unloading of the
  /// same cycles; more cycles than kMostCycles share their parts with their neighbours. Empty = one part.
  std::vector<std::vector<std::uint8_t>> part_of_scan;
  double longest_hold = 0;  ///< longest time at constant pressure [s]
  double lowest = 0;        ///< smallest pressure [Pa]
  double highest = 0;       ///< largest pressure [Pa]
  static constexpr std::size_t kMostCycles = 12;
};

/// Finds the protocols. `sections` has one entry for each recording. Where a feature varies from cycle to
/// cycle without a jump, its cycles are divided into a lower and an upper half. A group with less than 5 % of
/// the scans, such as the stump of a cycle at the end of a bag, is no protocol. With one protocol `names` has
/// one entry.
Protocols protocolsOf(const std::vector<Recording>& recordings, const std::vector<Sections>& sections);

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
