#pragma once

#include <string>

#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::report {

/// A prediction that was frozen with its verdict, before the recordings that test it were made.
struct FrozenPrediction {
  discrepancy::Prediction prediction;
  std::string verdict_sha256;  ///< of verdict.yaml's bytes
};

/// The text of prediction.yaml, with all digits of every number:
///
///     verdict_sha256: ...
///     effects: {hysteresis: {loop_width: 0.062, ...}}
///     rivals: [{creep: {...}}]
///     size: [0.9, 1.1]       # of the first effect, 1 = as fitted
///     hash: ...              # of effects, rivals, size and the simulation that they complete
std::string predictionText(const FrozenPrediction& frozen);

/// Reads prediction.yaml. Unknown keys are errors. Throws InputError that names file, field, value and what
/// would be right.
FrozenPrediction readPrediction(const std::string& path);

}  // namespace fsr::report
