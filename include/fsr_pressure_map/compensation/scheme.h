#pragma once

#include <string>
#include <vector>

namespace fsr::compensation {

/// How a model answers to curvature. Numbers of the paper's methods in brackets.
enum class Scheme {
  kFlatOnly,        ///< one model from the flat condition, used everywhere (Table 2, "flat")
  kBaseline,        ///< one model from all conditions together (baseline)
  kPerCurvature,    ///< one model a curvature (method 1)
  kCurvatureInput,  ///< curvature as an input beside the reading (method 2)
  kOneHot,          ///< one input for each curvature, 1 where it is the reading's, else 0 (method 2, one-hot)
  kFlatOrCurved,    ///< two models, one from flat, one from all bent conditions (method 3)
  kBinaryInput,     ///< an input that is 0 on flat, 1 on bent conditions (method 4)
  // Beyond the paper:
  kScaledCurvature,  ///< curvature as an input with a length scale of its own, found by cross-validation
  kCurvatureMap,     ///< interpolated along a monotone law of the matrix: its gain and preload by curvature
  kCurvatureRanges,  ///< one model a range of curvature: neighbours are merged where that costs nothing
  kInterpolated,     ///< one model a curvature, straight lines between neighbours
  kPerSurface,       ///< one model a surface name, for a mould on which the matrix was calibrated in place
};

/// The readable id that files, messages and options use, e.g. "per_curvature".
std::string schemeName(Scheme scheme);

/// What the paper calls it, e.g. "method 1"; "not in the paper" for those beyond it.
std::string schemeInPaper(Scheme scheme);

/// The scheme of that name; throws InputError that lists the names.
Scheme schemeFromName(const std::string& name);

std::vector<std::string> schemeNames();

/// Every name with the paper's in brackets, for help texts.
std::string schemeList();

/// Whether the scheme has a table for each curvature; else its one class answers everywhere.
bool usesCurvature(Scheme scheme);

/// Whether the scheme's model takes something of the curvature in beside the reading.
bool hasSecondInput(Scheme scheme);

}  // namespace fsr::compensation
