#pragma once

#include <cstddef>
#include <vector>

#include "compensation/training_statistics.h"
#include "regression/grnn/grnn.h"

namespace fsr::compensation {

/// Length scale of curvature [1/m] for a GRNN on reading and curvature, from 2^-6 to 2 times the range of
/// curvature. It minimises the product of two squared errors: on held-out sections and, from three classes
/// on, on inner classes that are left out as a whole. A decrease of one by a tenth thus balances an increase
/// of the other by a tenth; held-out sections alone would favour the shortest scale. 0 if all classes have
/// the same curvature.
///
/// There is one scale for the whole matrix. Scores of held-out sections use it too, although it was found
/// with them.
double learnScale(const TrainingStatistics& statistics, const regression::GrnnOptions& grnn,
                  const std::vector<std::size_t>& taxels, unsigned threads);

}  // namespace fsr::compensation
