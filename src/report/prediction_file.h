#pragma once

#include <string>
#include <vector>

#include "dataset/paces.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::report {

/// A prediction that was frozen with its verdict, before the recordings that test it were made.
struct FrozenPrediction {
  discrepancy::Prediction prediction;
  std::string verdict_sha256;  ///< of verdict.yaml's bytes
  /// Of the cycles that it was made from, see dataset::pacesOf(). Empty in files of earlier versions.
  std::vector<dataset::CycleCourse> paces = {};
  /// SHA-256 of the readings of each recording that it was made from. Empty in files of earlier versions.
  std::vector<std::string> readings_sha256 = {};
};

/// The text of prediction.yaml, with all digits of every number:
///
///     verdict_sha256: ...
///     effects: {hysteresis: {loop_width: 0.062, ...}}
///     rivals: [{creep: {...}}]
///     size: [0.9, 1.1]       # 95 % predictive interval of the effects' common factor, 1 = as fitted
///     weights: [0.8, 0.2]    # probability of the effects and of each rival
///     spread: {cycles: 24, groups: 6, between: 1e-4, parameters: [{effect: 0, name: loop_width,
///              logarithmic: false, covariance: [1.2e-06, ...]}, ...]}
///     paces: [{speed: 17000, dwell: 2, peak: 620000}, ...]   # of the cycles [Pa/s, s, Pa]
///     readings_sha256: [..., ...]   # of the readings of each bag
///     hash: ...              # of all above the paces, and of the simulation that it completes
///
/// Files of earlier versions have neither weights nor spread nor paces nor readings.
std::string predictionText(const FrozenPrediction& frozen);

/// Reads prediction.yaml. Unknown keys are errors. Throws InputError that names file, field, value and what
/// would be right.
FrozenPrediction readPrediction(const std::string& path);

}  // namespace fsr::report
