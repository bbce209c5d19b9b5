#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "discrepancy/fit/spline_basis.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// One value for each scan.
using Trace = Eigen::VectorXd;

/// Means over the used taxels [share of full scale], as they were read.
struct CommonTraces {
  Trace all;
  Trace halves[2];  ///< over the white and over the black squares of a chessboard of taxels
};
CommonTraces commonTraces(const Measured& measured);

/// Which static curve a scan belongs to.
enum class CurvePer { kClass, kVisit };

/// The common static curves: one smooth curve of pressure for each class of curvature (or each visit),
/// and what takes them out of a trace.
///
/// Between the cycles the gain scatters by chance. A trace's share along "gain of this cycle" is
/// therefore shrunk before the curves are taken out, so that least squares weigh it by what it is
/// worth: the cycles' gains are some dozens of numbers, not as many as there are scans.
class StaticFit {
 public:
  /// `common`: the trace that the curves are fitted to.
  StaticFit(const Measured& measured, CurvePer per, const Trace& common);
  /// The same as functions of another load than the chamber's pressure [Pa], with the cycles' gains
  /// weighed as in `like`.
  StaticFit(const StaticFit& like, const Trace& common, const Trace& load);

  const Trace& curve() const { return curve_; }         ///< static reading at each scan [share of full scale]
  const Trace& slope() const { return slope_; }         ///< never negative [share of full scale / Pa]
  const Trace& netCurve() const { return net_curve_; }  ///< static reading above the unloaded one

  /// Reading of a scan's curve at another load [Pa]; straight on beyond its ends, never below the unloaded
  /// one.
  double curveAt(std::size_t scan, double load) const;

  /// Lowest curve's lowest reading: a taxel without load [share of full scale].
  double unloaded() const { return zero_; }

  /// Deviation of the gain from cycle to cycle by chance, relative.
  double gainScatter() const { return gain_scatter_; }

  /// Shrinks along the cycles' gains, then takes out the static curves.
  Trace project(const Trace& trace) const;
  /// Undoes the shrinking of what project() returned.
  Trace withoutGainWeights(const Trace& projected) const;
  /// Takes out the static curves, nothing shrunk.
  Trace residual(const Trace& trace) const;

  /// Sets the scatter of the gain from what is left in a residual(), by the differences of one cycle
  /// from the next: what is slow is no scatter.
  void judgeGainScatter(const Trace& residual);

  std::size_t groupOf(std::size_t scan) const { return group_[scan]; }
  std::size_t groups() const { return groups_; }
  CurvePer per() const { return per_; }
  std::size_t coefficients() const { return basis_.size(); }
  const SplineBasis::Values& splines(std::size_t scan) const { return splines_[scan]; }

 private:
  using Normal = Eigen::LDLT<Eigen::MatrixXd>;
  template <typename Factor>
  void scaleGains(Trace& trace, Factor factor) const;
  void applyGainWeights(Trace& trace) const;
  Eigen::MatrixXd coefficientsOf(const Trace& trace, const std::vector<Normal>& normal) const;
  Trace curveFrom(const Eigen::MatrixXd& coefficients) const;
  void prepare();
  void fitCurves(const Trace& common, const Trace& load);

  const Measured& measured_;
  SplineBasis basis_{{0, 1}};
  std::vector<std::uint32_t> group_;  // of each scan
  std::size_t groups_ = 0;
  CurvePer per_ = CurvePer::kClass;
  std::vector<SplineBasis::Values> splines_;  // of each scan
  std::vector<Normal> plain_, weighted_;      // of each group
  Eigen::MatrixXd fitted_;                    // [coefficients x groups]
  Trace curve_, slope_, net_curve_;
  double zero_ = 0;
  double gain_scatter_ = 0;
  std::vector<double> gain_weight_;  // of each cycle: what shrink() leaves along its gain
};

}  // namespace fsr::discrepancy
