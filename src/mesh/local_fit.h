#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "mesh/mesh.h"

namespace fsr::mesh {

/// Frame on the sheet: a point [m] and, as columns of `axes`, the directions along the row, along the column
/// and out of the loaded face.
struct Frame {
  Point origin = Point::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// Lowest and highest degree of the polynomials that are fitted.
constexpr int kLowestDegree = 2;
constexpr int kHighestDegree = 4;

/// Number of coefficients of a polynomial of two variables.
constexpr std::size_t coefficients(int degree) {
  return std::size_t(degree + 1) * std::size_t(degree + 2) / 2;
}

/// Vertices that a polynomial needs: twice as many as coefficients.
constexpr std::size_t verticesFor(int degree) {
  return 2 * coefficients(degree);
}

/// The surface around one point of the mesh.
struct LocalFit {
  Frame frame;  ///< on the fitted surface: its third axis is the normal
  matrix::Curvature curvature;
  /// Covariance of curvature x, y and xy [1/m^2], for errors of the vertices that are independent.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double roughness = 0;      ///< standard deviation of the vertices from the fitted surface [m]
  double square_sum = 0;     ///< of the same distances [m^2]
  std::size_t vertices = 0;  ///< number of vertices in the fit
};

/// Least-squares fit of a polynomial z(x, y) of the given degree to points near `frame`, in a frame that is
/// turned until its third axis is the normal of the polynomial at x = y = 0. The curvature is then minus the
/// matrix of second derivatives there (positive where the surface falls away from the normal). The row's
/// direction is carried along without rotation about the normal. Nothing where the points do not determine
/// the polynomial.
std::optional<LocalFit> fitSurface(const std::vector<Point>& points, const Frame& frame, double radius,
                                   int degree);

}  // namespace fsr::mesh
