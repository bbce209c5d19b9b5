#pragma once

#include <cstddef>

namespace fsr::discrepancy {

/// Thresholds that several files share. A threshold that only one file uses stands in that file.
namespace thresholds {

/// Share of the readings' squared error. An effect, a pattern or a group of taxels that explains less does
/// not matter.
constexpr double kLeastShareOfError = 0.02;
/// Standard errors by which one explanation must be better than another.
constexpr double kSignificant = 2;
/// Share of the explainable error. An effect that explains less does not have the right form.
constexpr double kGoodForm = 0.7;
/// Share of the error that an effect with an arbitrary time course explains. A slow effect that is behind
/// by no more than this share may be the true one.
constexpr double kAnyCourseHides = 0.5;
/// Share of the largest root mean square. A taxel, a class of curvature or a mount with less does not show
/// the effect.
constexpr double kShows = 0.2;
/// The same for a bin of pressure.
constexpr double kPressureShows = 0.25;
/// Width of a bin of pressure [Pa].
constexpr double kPressureBin = 25e3;
/// Share of the highest pressure. Below it the sheet counts as unloaded.
constexpr double kLoaded = 0.1;

/// At least half of the taxels must be usable: detectors compare a taxel with the others.
constexpr bool enoughUsable(std::size_t usable, std::size_t taxels) {
  return 2 * usable >= taxels;
}

}  // namespace thresholds

}  // namespace fsr::discrepancy
