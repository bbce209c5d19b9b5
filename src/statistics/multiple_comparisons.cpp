#include "statistics/multiple_comparisons.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::statistics {

namespace {

void requireProbabilities(const std::vector<double>& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] >= 0 && p[i] <= 1) continue;
    throw settings::InputError("correction for multiple tests: p value " + std::to_string(i + 1) + " is " +
                               std::to_string(p[i]) + "; it must lie between 0 and 1");
  }
}

}  // namespace

std::vector<double> bonferroni(const std::vector<double>& p) {
  requireProbabilities(p);
  std::vector<double> adjusted;
  for (const double value : p) adjusted.push_back(std::min(1.0, static_cast<double>(p.size()) * value));
  return adjusted;
}

}  // namespace fsr::statistics
