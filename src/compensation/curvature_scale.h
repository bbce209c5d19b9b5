#pragma once

#include <cstddef>
#include <vector>

#include "compensation/training_statistics.h"
#include "regression/grnn/grnn.h"

namespace fsr::compensation {

/// Length scale of curvature [1/m] for a GRNN on reading and curvature, of 2^-6 to 2 times the range of
/// curvature: that of the least product of two squared errors, on held-out sections and, from three classes
/// on, on inner classes left out as a whole. A tenth less of one is worth a tenth more of the other; sections
/// alone would want it as short as can be. 0 where all classes have one curvature.
///
/// It is one number of the whole matrix: scores of held-out sections use it too, though it has seen them.
double learnScale(const TrainingStatistics& statistics, const regression::GrnnOptions& grnn,
                  const std::vector<std::size_t>& taxels, unsigned threads);

}  // namespace fsr::compensation
