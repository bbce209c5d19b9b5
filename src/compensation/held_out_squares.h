#pragma once

#include <vector>

#include "regression/code_statistics.h"

namespace fsr::compensation {

/// Sum of the squared errors of `pressure` [Pa, one for each code] on readings of which the sums are known
/// [Pa^2].
double squaredErrors(const regression::CodeStatistics& readings, const std::vector<double>& pressure);

/// [taxels][values] summed over taxels, always in their order.
std::vector<double> sumOverTaxels(const std::vector<std::vector<double>>& of_taxel);

}  // namespace fsr::compensation
