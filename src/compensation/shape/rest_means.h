#pragma once

#include <Eigen/Dense>
#include <vector>

#include "fsr_pressure_map/compensation/shape.h"

namespace fsr::compensation {

/// Covariance of the field of a mount between taxels, without `white`, [taxels x taxels] [Pa^2].
Eigen::MatrixXd fieldCovariance(const MountScatter& scatter, const std::vector<matrix::Position>& places);

/// What was measured at rest, of the taxels that take part, and what mounts do to it.
struct RestMeans {
  explicit RestMeans(const ShapeModel& model);

  std::vector<std::size_t> taxels;  ///< their numbers
  Eigen::MatrixXd rest;             ///< [surfaces x taxels] [Pa]
  Eigen::VectorXd mean;             ///< [surfaces], over the taxels [Pa]
  Eigen::MatrixXd field;            ///< covariance of one mount [taxels x taxels] [Pa^2]
  Eigen::MatrixXd beside;           ///< the same of what is beside the mean over the taxels
  double field_mean = 0;            ///< variance of the mean over the taxels [Pa^2]
  double freedom = 0;               ///< of the scatter (F. E. Satterthwaite, Biometrics Bulletin 2, 1946)
  double mount_variance = 0;        ///< of one mount at one taxel [Pa^2]
  Eigen::VectorXd mounted;          ///< [surfaces], variance of a mean in variances of one mount
  Eigen::VectorXd cut;              ///< [surfaces], further variance of a mean where readings are 0 [Pa^2]
};

/// Covariance between two curvatures of the mean over the taxels [Pa^2], see ShapeLaw. It contains a large
/// variance of an unknown constant.
double commonCovariance(const ShapeLaw& law, double k, double l);
/// The same of a taxel beside that mean, without own_white. `mean_k`, `mean_l`: the mean there [Pa].
double ownCovariance(const ShapeLaw& law, double k, double l, double mean_k, double mean_l);

/// Both between all surfaces of a model, [surfaces x surfaces].
Eigen::MatrixXd commonCovariances(const ShapeModel& model);
Eigen::MatrixXd ownCovariances(const ShapeModel& model, const Eigen::VectorXd& mean);

}  // namespace fsr::compensation
