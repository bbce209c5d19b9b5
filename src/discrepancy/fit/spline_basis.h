#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace fsr::discrepancy {

/// Cubic B-splines over unevenly spaced knots. They form smooth curves that are linear in their coefficients.
/// At each point only four splines differ from 0. Source: C. de Boor, A Practical Guide to Splines, Springer
/// 1978.
class SplineBasis {
 public:
  static constexpr std::size_t kAtOnce = 4;

  /// `knots`: at least two, ascending, including both ends.
  explicit SplineBasis(const std::vector<double>& knots);

  /// Number of coefficients: knots + 2.
  std::size_t size() const { return knots_.size() - kAtOnce; }

  double low() const { return knots_.front(); }
  double high() const { return knots_.back(); }

  /// Middle of a spline: Greville's abscissa. Coefficients that are a line over the middles make a line.
  double middle(std::size_t spline) const {
    return (knots_[spline + 1] + knots_[spline + 2] + knots_[spline + 3]) / 3;
  }

  /// Values and slopes of the splines first .. first + 3 at `x`; beyond an end, those at that end.
  struct Values {
    std::size_t first = 0;
    std::array<double, kAtOnce> value{};
    std::array<double, kAtOnce> slope{};
  };
  Values at(double x) const;

 private:
  std::size_t piece(double x) const;

  std::vector<double> knots_;  // each end four times
};

}  // namespace fsr::discrepancy
