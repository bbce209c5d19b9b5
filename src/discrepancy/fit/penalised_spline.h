#pragma once

#include <Eigen/Dense>
#include <vector>

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

}  // namespace fsr::discrepancy
