#pragma once

#include <Eigen/Dense>
#include <vector>

#include "fsr_pressure_map/calibration/shape.h"

namespace fsr::calibration {

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

/// Readings of all taxels at rest as they are predicted for a curvature.
struct RestPrediction {
  Eigen::VectorXd mean;        ///< [taxels] [Pa]
  Eigen::MatrixXd covariance;  ///< of one new mount [taxels x taxels] [Pa^2]
};

/// Predicts readings at rest for any curvature: kriging over the curvatures of training, of the mean over the
/// taxels and of each taxel beside it (N. Cressie, Statistics for Spatial Data, 1993, ch. 3). The weights are
/// the same for all taxels, so the error of a prediction is known even where the fields of mounts are
/// correlated over the sheet.
class RestLaw {
 public:
  /// `model` must be present and must outlive the object.
  explicit RestLaw(const ShapeModel& model);

  /// `curvature`: principal, of each taxel that takes part [1/m].
  RestPrediction predict(const Eigen::VectorXd& curvature) const;

  const RestMeans& means() const { return means_; }

 private:
  struct Weights {
    Eigen::VectorXd common, own;        // [surfaces]
    Eigen::VectorXd common_covariance;  // with the surfaces [Pa^2]
    double mean = 0;                    // over the taxels [Pa]
    double own_variance = 0;            // [Pa^2]
    double gain = 1;
  };
  Weights weightsAt(double curvature) const;
  /// Covariance of the error of the mean over the taxels; each row of the arguments belongs to a taxel.
  Eigen::MatrixXd errorOfMean(const Eigen::VectorXd& curvature, const Eigen::MatrixXd& weights,
                              const Eigen::MatrixXd& covariance) const;

  const ShapeModel& model_;
  RestMeans means_;
  Eigen::MatrixXd common_, own_;  // covariances between the surfaces
  Eigen::LDLT<Eigen::MatrixXd> common_solver_, own_solver_;
  Eigen::VectorXd shares_;  // [taxels], how strongly a taxel follows the mean
};

}  // namespace fsr::calibration
