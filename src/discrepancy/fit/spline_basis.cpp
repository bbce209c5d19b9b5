#include "discrepancy/fit/spline_basis.h"

#include <algorithm>

namespace fsr::discrepancy {

SplineBasis::SplineBasis(const std::vector<double>& knots) {
  knots_.assign(kAtOnce - 1, knots.front());
  knots_.insert(knots_.end(), knots.begin(), knots.end());
  knots_.insert(knots_.end(), kAtOnce - 1, knots.back());
}

std::size_t SplineBasis::piece(double x) const {
  const auto last = knots_.end() - static_cast<std::ptrdiff_t>(kAtOnce);
  const auto after = std::upper_bound(knots_.begin() + kAtOnce, last, x);
  return static_cast<std::size_t>(after - knots_.begin()) - 1;
}

SplineBasis::Values SplineBasis::at(double x) const {
  x = std::clamp(x, knots_.front(), knots_.back());
  const std::size_t k = piece(x);
  Values values;
  values.first = k - (kAtOnce - 1);
  std::array<double, kAtOnce> lower{1, 0, 0, 0}, next{};
  // Cox and de Boor's recursion, degree by degree. The last but one degree gives the slopes.
  for (std::size_t degree = 1; degree < kAtOnce; ++degree) {
    next.fill(0);
    if (degree == kAtOnce - 1) values.slope.fill(0);
    for (std::size_t j = 0; j < degree; ++j) {
      const double left = knots_[k + j + 1 - degree], right = knots_[k + j + 1];
      const double share = lower[j] / (right - left);
      next[j] += (right - x) * share;
      next[j + 1] += (x - left) * share;
      if (degree == kAtOnce - 1) {
        values.slope[j] -= static_cast<double>(degree) * share;
        values.slope[j + 1] += static_cast<double>(degree) * share;
      }
    }
    lower = next;
  }
  values.value = lower;
  return values;
}

}  // namespace fsr::discrepancy
