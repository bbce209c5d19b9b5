#pragma once

#include <string>
#include <vector>

namespace fsr::compensation {

/// How a calibration uses curvature. In brackets the methods of the paper (Ahmadizadeh and Menon 2019,
/// doi:10.3390/s19245519).
enum class Scheme {
  kFlatOnly,        ///< one model from the flat condition, used everywhere (Table 2, "flat")
  kBaseline,        ///< one model from all conditions together (baseline)
  kPerCurvature,    ///< one model for each curvature (method 1)
  kCurvatureInput,  ///< curvature as an input in addition to the reading (method 2)
  kOneHot,          ///< one input for each curvature, 1 if it is the reading's, else 0 (method 2, one-hot)
  kFlatOrCurved,    ///< two models, one from the flat condition and one from all bent conditions (method 3)
  kBinaryInput,     ///< an input that is 0 on flat and 1 on bent conditions (method 4)
  // Not in the paper:
  kScaledCurvature,  ///< curvature as an input with its own length scale, found by cross-validation
  kCurvatureMap,     ///< interpolated along a monotone function of curvature: gain and preload of the matrix
  kCurvatureRanges,  ///< one model for each range of curvature: neighbouring classes are merged if the error
                     ///< hardly increases
  kInterpolated,     ///< one model for each curvature, linear interpolation between neighbours
  kPerSurface,  ///< one model for each surface name, for a mould on which the matrix was calibrated in place
};

/// The id that files, messages and options use, e.g. "per_curvature".
std::string schemeName(Scheme scheme);

/// The name in the paper, e.g. "method 1"; "not in the paper" for the others.
std::string schemeInPaper(Scheme scheme);

/// The scheme of that name. Throws InputError that lists the names.
Scheme schemeFromName(const std::string& name);

std::vector<std::string> schemeNames();

/// All names, each with that of the paper in brackets, for help texts.
std::string schemeList();

/// Whether the scheme has a table for each curvature. Otherwise its only class answers everywhere.
bool usesCurvature(Scheme scheme);

/// Whether the model has an input from the curvature in addition to the reading.
bool hasSecondInput(Scheme scheme);

}  // namespace fsr::compensation
