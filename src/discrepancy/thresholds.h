#pragma once

#include <cstddef>

namespace fsr::discrepancy {

/// Thresholds that several files share. A threshold that only one file uses stands in that file.
namespace thresholds {

/// Share of the readings' squared error. An effect, a pattern or a group of taxels that explains less does
/// not matter.
constexpr double kLeastShareOfError = 0.02;
/// Share of the largest root mean square. A taxel, a class of curvature or a mount with less does not show
/// the effect.
constexpr double kShows = 0.2;
/// The same for a bin of pressure.
constexpr double kPressureShows = 0.25;
/// Width of a bin of pressure [Pa].
constexpr double kPressureBin = 25e3;
/// Share of the highest pressure. Below it the sheet counts as unloaded.
constexpr double kLoaded = 0.1;
/// Smallest range of the chamber pressure [Pa].
constexpr double kLeastRange = 10e3;

/// At least half of the taxels must be usable: detectors compare a taxel with the others.
constexpr bool enoughUsable(std::size_t usable, std::size_t taxels) {
  return 2 * usable >= taxels;
}

}  // namespace thresholds

}  // namespace fsr::discrepancy
