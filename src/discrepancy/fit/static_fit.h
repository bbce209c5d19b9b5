#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/settings/range.h"

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

/// One value for each scan.
using Trace = Eigen::VectorXd;

/// Means of the readings over the used taxels [share of full scale]; no curve is subtracted.
struct CommonTraces {
  Trace all;
};
CommonTraces commonTraces(const Measured& measured);

/// Which scans share a static curve: those of one class of curvature, or those of one visit.
enum class CurvePer { kClass, kVisit };

/// The common static curves: one smooth curve of pressure for each class of curvature (or each visit). The
/// class also removes these curves from a trace. The curves are fitted to the fit cycles only; a group
/// without a fit cycle has a curve of its own hold-out cycles. Beyond the pressures that were fitted a curve
/// continues as a straight line.
///
/// The gain scatters by chance from cycle to cycle. Therefore a trace's component along "gain of this cycle"
/// is shrunk before the curves are removed. Least squares then give it the weight it deserves: the cycles'
/// gains are some dozens of numbers, not as many as there are scans.
class StaticFit {
 public:
  /// `common`: the trace to which the curves are fitted.
  StaticFit(const Measured& measured, CurvePer per, const Trace& common);
  /// Fits the curves as functions of `load` [Pa] instead of the chamber's pressure. The cycles' gains keep
  /// their weights from `like`.
  StaticFit(const StaticFit& like, const Trace& common, const Trace& load);

  const Trace& curve() const { return curve_; }         ///< static reading at each scan [share of full scale]
  const Trace& slope() const { return slope_; }         ///< never negative [share of full scale / Pa]
  const Trace& netCurve() const { return net_curve_; }  ///< static reading above the unloaded one

  /// Reading of a scan's curve at another load [Pa]. Beyond its ends the curve continues as a straight line,
  /// never below the unloaded reading.
  double curveAt(std::size_t scan, double load) const;

  /// Reading of a taxel without load: the lowest reading of the lowest curve [share of full scale].
  double unloaded() const { return zero_; }

  /// Shrinks the trace along the cycles' gains, then removes the static curves.
  Trace project(const Trace& trace) const;
  /// Removes the static curves without shrinking anything.
  Trace residual(const Trace& trace) const;

  /// Estimates the scatter of the gain from a residual(). The estimate uses the differences between
  /// consecutive cycles, so slow trends are not counted as scatter.
  void judgeGainScatter(const Trace& residual);

  /// Whether the curves are fitted to a scan.
  bool isFitted(std::size_t scan) const { return fits_[scan]; }
  std::size_t groupOf(std::size_t scan) const { return group_[scan]; }
  std::size_t groups() const { return groups_; }
  CurvePer per() const { return per_; }
  std::size_t coefficients() const { return basis_.size(); }
  const SplineBasis::Values& splines(std::size_t scan) const { return splines_[scan]; }

 private:
  using Normal = Eigen::LDLT<Eigen::MatrixXd>;
  void applyGainWeights(Trace& trace) const;
  Eigen::MatrixXd coefficientsOf(const Trace& trace, const std::vector<Normal>& normal) const;
  Trace curveFrom(const Eigen::MatrixXd& coefficients) const;
  std::vector<Eigen::MatrixXd> normalMatrices() const;
  void prepare();
  void fitCurves(const Trace& common, const Trace& load);

  const Measured& measured_;
  SplineBasis basis_{{0, 1}};
  std::vector<std::uint32_t> group_;  // of each scan
  std::vector<bool> fits_;            // of each scan: the curves are fitted to it
  std::size_t groups_ = 0;
  CurvePer per_ = CurvePer::kClass;
  std::vector<SplineBasis::Values> splines_;  // of each scan
  std::vector<Normal> plain_, weighted_;      // of each group
  Eigen::MatrixXd fitted_;                    // [coefficients x groups]
  std::vector<settings::Range> reach_;        // of each group: loads to which its curve is fitted [Pa]
  Trace curve_, slope_, net_curve_;
  double zero_ = 0;
  std::vector<double> gain_weight_;  // of each cycle: factor along its gain in project()
};

}  // namespace fsr::discrepancy
