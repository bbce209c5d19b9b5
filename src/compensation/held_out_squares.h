#pragma once

#include <vector>

#include "regression/code_statistics.h"

namespace fsr::compensation {

/// Sum of squared errors [Pa^2] of `pressure` [codes] [Pa] on readings whose sums are known.
double squaredErrors(const regression::CodeStatistics& readings, const std::vector<double>& pressure);

/// Sum of [taxels][values] over taxels, always in the same order.
std::vector<double> sumOverTaxels(const std::vector<std::vector<double>>& of_taxel);

}  // namespace fsr::compensation
