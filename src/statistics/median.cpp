#include "statistics/median.h"

#include <algorithm>

namespace fsr::statistics {

double upperMedian(std::vector<double> values, double of_none) {
  if (values.empty()) return of_none;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace fsr::statistics
