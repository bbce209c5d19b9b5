#pragma once

#include <cstddef>
#include <vector>

#include "compensation/training_statistics.h"
#include "regression/grnn/grnn.h"

namespace fsr::compensation {

/// Classes that share one model, ascending.
using CurvatureRange = std::vector<std::size_t>;

/// Starts with one range for each class and merges neighbouring ranges, the cheapest first, as long as a
/// merge increases the squared error on held-out sections by no more than kMergeCost.
std::vector<CurvatureRange> learnRanges(const TrainingStatistics& statistics, const regression::Grnn& grnn,
                                        const std::vector<std::size_t>& taxels, unsigned threads);

constexpr double kMergeCost = 0.02;

}  // namespace fsr::compensation
