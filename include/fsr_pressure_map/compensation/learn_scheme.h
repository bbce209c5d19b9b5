#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/compensation/scheme_plan.h"
#include "fsr_pressure_map/compensation/training_statistics.h"
#include "fsr_pressure_map/regression/grnn.h"

namespace fsr {

/// Finds what a scheme takes from the data of the whole matrix, and writes it into the plan; does nothing for
/// the others. `taxels` = those to look at, one or more, each with a model. `grnn` is the model that all
/// comparisons are made with, whatever regressor is trained in the end.
///
/// scaled_curvature: the length scale of least error, that on held-out sections and, from three classes on,
/// that on inner classes left out as a whole, counted alike; of 2^-6 to 2 times the range of curvature. A
/// scale that serves surfaces of training alone would be as short as can be.
///
/// curvature_ranges: neighbouring ranges are merged as long as that raises the squared error on held-out
/// sections by no more than kMergeCost, the cheapest first.
void learnScheme(const TrainingStatistics& statistics, const GrnnOptions& grnn,
                 const std::vector<std::size_t>& taxels, unsigned threads, SchemePlan& plan);

constexpr double kMergeCost = 0.02;

}  // namespace fsr
