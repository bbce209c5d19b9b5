#pragma once

#include <cstddef>
#include <vector>

#include "compensation/scheme_plan.h"
#include "compensation/training_statistics.h"
#include "regression/code_statistics.h"
#include "regression/grnn/grnn.h"

namespace fsr::compensation {

/// Sum of squared errors [Pa^2] of `pressure` [codes] [Pa] on readings whose sums are known.
double squaredErrors(const regression::CodeStatistics& readings, const std::vector<double>& pressure);

/// Sum of [taxels][values] over taxels, always in the same order.
std::vector<double> sumOverTaxels(const std::vector<std::vector<double>>& of_taxel);

/// Classes that share one model, ascending.
using CurvatureRange = std::vector<std::size_t>;

/// Starts with one range for each class and merges neighbouring ranges, the cheapest first, as long as a
/// merge increases the squared error on held-out sections by no more than kMergeCost.
std::vector<CurvatureRange> learnRanges(const TrainingStatistics& statistics, const regression::Grnn& grnn,
                                        const std::vector<std::size_t>& taxels, unsigned threads);

constexpr double kMergeCost = 0.02;

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

/// Finds the parameters that a scheme takes from the data of the whole matrix (see curvature_scale.h,
/// curvature_ranges.h) and stores them in the plan. Does nothing for schemes without such parameters.
/// `taxels` are the taxels to use, one or more, each with a model. All comparisons are made with a GRNN with
/// options `grnn`, whatever regressor is trained in the end.
void learnScheme(const TrainingStatistics& statistics, const regression::GrnnOptions& grnn,
                 const std::vector<std::size_t>& taxels, unsigned threads, SchemePlan& plan);

}  // namespace fsr::compensation
