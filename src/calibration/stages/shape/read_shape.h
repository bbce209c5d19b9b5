#pragma once

#include <Eigen/Dense>
#include <vector>

#include "calibration/stages/shape/rest_law.h"
#include "fsr_pressure_map/calibration/shape.h"

namespace fsr::calibration {

/// Of readings at rest, for an assumed curvature.
struct RestLikelihood {
  double logarithm = 0;  ///< up to the constant of ShapeEstimate::likelihood
  double distance = 0;   ///< between readings and prediction (Mahalanobis), squared
};

/// Tells the curvature of the sheet from its readings at rest: likelihood of the readings under RestLaw on a
/// grid of curvatures, with a flat prior over the training and a quarter of its range on both sides. The
/// likelihood is Student's, because the scatter of mounts was learnt from few (degrees: RestMeans::freedom).
class ShapeReader {
 public:
  /// `model` must be present and must outlive the object.
  explicit ShapeReader(const ShapeModel& model);

  /// Throws InputError if the number of taxels differs, or fewer than half of the taxels that take part have
  /// a reading.
  ShapeEstimate estimate(const RestReading& rest) const;

  /// Likelihood of a declared surface. `curvature`: principal, one or one for each taxel [1/m]. Throws as
  /// estimate().
  RestLikelihood likelihood(const RestReading& rest, const std::vector<double>& curvature) const;

  /// Probability of a distance as large as this or larger, if the curvature is true.
  double fit(double distance, std::size_t taxels) const;

  /// The curvatures that are compared, ascending [1/m].
  const std::vector<double>& grid() const { return grid_; }

 private:
  struct Sample {
    Eigen::VectorXd pressure;          // of the taxels that have a reading [Pa]
    Eigen::VectorXd further_variance;  // where the reading is cut [Pa^2]
    std::vector<Eigen::Index> at;      // their places among the taxels of the law
  };
  Sample sampleOf(const RestReading& rest) const;
  RestLikelihood likelihood(const Sample& sample, const Eigen::VectorXd& curvature) const;
  RestLikelihood likelihood(const Sample& sample, double curvature) const;
  void addErrorBetween(ShapeEstimate& estimate) const;

  const ShapeModel& model_;
  RestLaw law_;
  std::vector<double> grid_;  // curvatures, ascending [1/m]
};

/// The model as it would be without one surface, which must be neither the first nor the last; the scatter
/// and the law stay.
ShapeModel withoutSurface(ShapeModel model, std::size_t surface);

/// The pressure that stands for a reading, see ShapeModel::scale [Pa].
double scaledPressure(const ShapeModel& model, std::size_t taxel, double reading);

}  // namespace fsr::calibration
