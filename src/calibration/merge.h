#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// A calibration with its statistics, and its name in error messages.
struct MergePart {
  std::string name;
  Calibration calibration;
};

struct MergeOptions {
  unsigned threads = 0;  ///< 0 = one for each core
  std::string date;      ///< ISO 8601, UTC; empty = now
};

/// The calibration that training on the bags of all parts, in their order and without scores (those need the
/// bags), would give, bit for bit: the sums of pressure by code are integers, sections were formed within
/// each bag, and everything else follows from them.
///
/// Throws InputError, one sentence, if parts differ in matrix, converter, board, scheme, model or number of
/// sections, contain the same bag, have no statistics, if the model needs the bags (forest, monotone curve,
/// GRNN with equal weights of pressure bins), or if all conditions together would form other curvature
/// classes.
Calibration mergeCalibrations(const std::vector<MergePart>& parts, const MergeOptions& options = {});

}  // namespace fsr::calibration
