#pragma once

#include <Eigen/Dense>
#include <vector>

#include "compensation/shape/rest_means.h"
#include "fsr_pressure_map/compensation/shape.h"

namespace fsr::compensation {

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

}  // namespace fsr::compensation
