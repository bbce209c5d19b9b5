#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "discrepancy/samples/views.h"
#include "simulation/taxel_curves.h"

namespace fsr::discrepancy {

/// Sums over data for the least-squares fit of a natural cubic spline through fixed knots.
class SplineSums {
 public:
  explicit SplineSums(std::size_t knots);

  /// Adds a value. The model is `slope` x spline(at); `weights` are those of the place.
  void add(const simulation::SplineWeights& weights, double slope, double value);

  double number() const { return number_; }
  double square() const { return square_; }
  /// Normal matrix and right side over the values at the knots. `bends`: see splineBends().
  Eigen::MatrixXd normal(const Eigen::MatrixXd& bends) const;
  Eigen::VectorXd right(const Eigen::MatrixXd& bends) const;
  bool sameDesign(const SplineSums& other) const { return normal_ == other.normal_; }

 private:
  Eigen::MatrixXd normal_;  // over values and second derivatives at the knots
  Eigen::VectorXd right_;
  double number_ = 0, square_ = 0;
};

/// One data set in a basis in which normal matrix and penalty are diagonal (A. Demmler, C. Reinsch, Numer.
/// Math. 24 (1975) 375).
class PenalisedSpline {
 public:
  PenalisedSpline(Eigen::MatrixXd normal, Eigen::VectorXd right, double square, double number);
  /// Data of the same design as another.
  PenalisedSpline(const PenalisedSpline& like, Eigen::VectorXd right, double square, double number);

  /// Values at the knots for a weight of the penalty, relative to the mean diagonal of the normal matrix.
  Eigen::VectorXd values(double weight) const;
  double number() const { return number_; }
  /// Number of data times the squared error over squared degrees of freedom: the term of generalised
  /// cross-validation.
  double crossValidated(double weight) const;
  /// The same where the spline must not fall below `least` slopes: rows of `slopes` x values >= least.
  Eigen::VectorXd valuesRising(double weight, const Eigen::MatrixXd& slopes,
                               const Eigen::VectorXd& least) const;

  static constexpr double kLeastWeight = 1e-7, kMostWeight = 1e3;

 private:
  double penalty(double weight) const { return (weight - kLeastWeight) * unit_; }

  Eigen::MatrixXd normal_;  // with the least penalty
  Eigen::VectorXd right_;
  double square_, number_, unit_ = 1;
  Eigen::MatrixXd back_;       // from the diagonal basis to values at the knots
  Eigen::VectorXd roughness_;  // of each member of the basis
};

/// The matrix of squared second differences of the values at the knots.
Eigen::MatrixXd secondDifferences(Eigen::Index knots);

/// The weight with the smallest sum of cross-validated errors over all data sets that are not empty.
double chooseWeight(const std::vector<PenalisedSpline>& splines);

/// Returns the simulation with curves of single taxels added (see TaxelCurves): one for each taxel and each
/// class of curvature, as a function of the load that the chain computes with the effects that the simulation
/// enables. They are penalised cubic splines through at most 40 knots: least squares plus second differences,
/// with the weight of the latter by generalised cross-validation, one for each surface (P. Eilers, B. Marx,
/// Statist. Sci. 11 (1996) 89; Y.-J. Kim, C. Gu, J. R. Statist. Soc. B 66 (2004) 337). The static curve with
/// its deviation never falls (K. Bollaerts, P. Eilers, I. van Mechelen, Statist. Med. 25 (2006) 1552). Beyond
/// their ends they are straight lines. Effects that come and go at random are left out while they are fitted.
/// `file` is the name of the table in the settings.
simulation::SimulationSettings withTaxelCurves(const FitView& fit,
                                               const simulation::SimulationSettings& simulation,
                                               const std::string& file);

}  // namespace fsr::discrepancy
