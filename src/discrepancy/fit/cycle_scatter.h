#pragma once

#include <vector>

#include "discrepancy/fit/cycle_noise.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// The slow parts of a fitted noise, as sizes with intervals: cycle_gain, cycle_offset and wandering.
///
/// The intervals are of the likelihood: the inverse of the expected information on all variances gives the
/// standard error of each. The logarithm of a variance is taken as normal where the variance exceeds two
/// standard errors; else the interval begins at 0. Source: S. Searle, G. Casella, C. McCulloch, Variance
/// Components, Wiley 1992, chapter 6. Empty for fewer than three cycles.
std::vector<Scatter> scatterOf(const CycleDesign& design, const CycleNoise& noise);

}  // namespace fsr::discrepancy
