#pragma once

#include <cstddef>
#include <vector>

#include "compensation/scheme_plan.h"
#include "compensation/training_statistics.h"
#include "regression/grnn/grnn.h"

namespace fsr::compensation {

/// Finds the parameters that a scheme takes from the data of the whole matrix (see curvature_scale.h,
/// curvature_ranges.h) and stores them in the plan. Does nothing for schemes without such parameters.
/// `taxels` are the taxels to use, one or more, each with a model. All comparisons are made with a GRNN with
/// options `grnn`, whatever regressor is trained in the end.
void learnScheme(const TrainingStatistics& statistics, const regression::GrnnOptions& grnn,
                 const std::vector<std::size_t>& taxels, unsigned threads, SchemePlan& plan);

}  // namespace fsr::compensation
