#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace fsr::discrepancy {

/// Cubic B-splines over unevenly spaced knots: smooth curves that are linear in their coefficients and of
/// which four at a time differ from 0. Source: C. de Boor, A Practical Guide to Splines, Springer 1978.
class SplineBasis {
 public:
  static constexpr std::size_t kAtOnce = 4;

  /// `knots`: at least two, ascending, the ends included.
  explicit SplineBasis(const std::vector<double>& knots);

  /// Number of coefficients: knots + 2.
  std::size_t size() const { return knots_.size() - kAtOnce; }

  double low() const { return knots_.front(); }
  double high() const { return knots_.back(); }

  /// The splines first .. first + 3 and their slopes at `x`; beyond the ends the values there.
  struct Values {
    std::size_t first = 0;
    std::array<double, kAtOnce> value{};
    std::array<double, kAtOnce> slope{};
  };
  Values at(double x) const;

 private:
  std::size_t piece(double x) const;

  std::vector<double> knots_;  // the ends four times over
};

}  // namespace fsr::discrepancy
