#pragma once

#include <cstddef>
#include <vector>

#include "compensation/scheme_plan.h"
#include "compensation/training_statistics.h"
#include "regression/grnn/grnn.h"

namespace fsr::compensation {

/// Finds what a scheme takes from the data of the whole matrix (see curvature_scale.h, curvature_ranges.h)
/// and writes it into the plan; does nothing for the others. `taxels` = those to look at, one or more, each
/// with a model. `grnn` is the model that all comparisons are made with, whatever regressor is trained in the
/// end.
void learnScheme(const TrainingStatistics& statistics, const regression::GrnnOptions& grnn,
                 const std::vector<std::size_t>& taxels, unsigned threads, SchemePlan& plan);

}  // namespace fsr::compensation
