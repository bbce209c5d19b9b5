#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"
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

/// Where a matrix lies on a mesh.
struct SheetPlace {
  matrix::Layout layout;
  Point at = Point::Zero();              ///< middle of the matrix, on the mesh or close to it [m]
  Point row_direction = Point::UnitX();  ///< along the rows; its part along the normal is left out
  bool along_normals = true;             ///< +z of the sheet along the normals of the triangles, or against
  std::optional<double> radius;          ///< of the fits [m]; without it the larger pitch, see SheetFit
};

/// One taxel of a matrix on a mesh.
struct SheetFit {
  LocalFit fit;
  /// Radius of the fit [m]. Where fewer than verticesFor(kLowestDegree) vertices lie within the radius of
  /// SheetPlace, it is larger, at most by the factor kLargestGrowth.
  double radius = 0;
};

constexpr double kLargestGrowth = 3;
/// The middle of the matrix may be this far from the mesh [m].
constexpr double kLargestDistance = 0.005;

/// A matrix on a mesh.
struct LaidSheet {
  Frame middle;                  ///< of the matrix, on the mesh: the matrix frame in the frame of the mesh
  std::vector<SheetFit> taxels;  ///< [rows x columns], row-major
  int degree = kLowestDegree;    ///< of the polynomials
  /// Root mean square over the taxels of the error that the polynomials' degree makes in the curvature [1/m].
  double bias = 0;
  double distance = 0;  ///< from SheetPlace::at to the mesh [m]
};

/// Lays the sheet on the mesh without stretching its rows and its middle column: a frame moves along a
/// geodesic from the middle of the matrix up and down the middle column, then from there along each row, as
/// in view::bendSheet(). The frame is carried without rotation about the normal.
///
/// The surface is a polynomial, fitted at each step to the vertices within the radius. At the taxels the
/// degree is that of kLowestDegree to kHighestDegree with the smallest mean squared error of the curvature:
/// its variance, and the square of its bias against the highest degree, of which the variance of the
/// difference is subtracted (a focused information criterion: G. Claeskens, N. L. Hjort, J. Am. Stat. Assoc.
/// 98 (2003) 900). A smooth mesh gets a high degree, a rough one a low degree. One degree is taken for all
/// taxels.
///
/// Throws InputError where the place is not on the mesh, the row's direction is along the normal, or a taxel
/// is beside the mesh, in a hole of it or where it has too few vertices; the sentence names row and column.
LaidSheet laySheet(const Mesh& mesh, const SheetPlace& place);

}  // namespace fsr::mesh
