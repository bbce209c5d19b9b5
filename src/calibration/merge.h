#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// A calibration with its statistics, and the name that sentences give it.
struct MergePart {
  std::string name;
  Calibration calibration;
};

struct MergeOptions {
  unsigned threads = 0;  ///< 0 = one for each core
  std::string date;      ///< ISO 8601, UTC; empty = now
};

/// The calibration that training on the bags of all parts would give, in their order and without scores
/// (those need the bags), bit for bit: sums of pressure by code are integers, sections were formed within
/// each bag, and everything else follows from them.
///
/// Throws InputError, one sentence, where parts are of another matrix, converter, board, scheme, model or
/// number of sections, hold the same bag, have no statistics, where the model needs the bags (a forest, a
/// monotone curve, a GRNN that weighs pressure bins alike), or where all conditions together would form
/// other curvature classes.
Calibration mergeCalibrations(const std::vector<MergePart>& parts, const MergeOptions& options = {});

}  // namespace fsr::calibration
