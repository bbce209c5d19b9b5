#include "mesh/local_fit.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace fsr::mesh {

namespace {

constexpr int kTurns = 20;             // of the frame towards the normal
constexpr double kSameNormal = 1e-10;  // slope that counts as none

// Places of the monomials in a polynomial: 1, x, y, xx, xy, yy, ...
enum Place { kConstant, kX, kY, kXX, kXY, kYY };

struct Polynomial {
  Eigen::VectorXd coefficients;  // lengths in units of the radius
  Eigen::MatrixXd inverse;       // of the normal matrix
  double square_sum = 0;         // of the residuals, in units of the radius
};

// x, y and z of the points in the frame, in units of the radius.
Eigen::MatrixX3d localPoints(const std::vector<Point>& points, const Frame& frame, double radius) {
  Eigen::MatrixX3d local(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    local.row(Eigen::Index(i)) = (frame.axes.transpose() * (points[i] - frame.origin)).transpose() / radius;
  }
  return local;
}

std::optional<Polynomial> fitPolynomial(const Eigen::MatrixX3d& points, int degree) {
  const auto terms = Eigen::Index(coefficients(degree));
  Eigen::MatrixXd design(points.rows(), terms);
  Eigen::Index term = 0;
  for (int order = 0; order <= degree; ++order) {
    for (int power = 0; power <= order; ++power) {
      design.col(term++) = points.col(0).array().pow(order - power) * points.col(1).array().pow(power);
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(design);
  if (solver.rank() < terms) return std::nullopt;
  Polynomial result;
  result.coefficients = solver.solve(points.col(2));
  result.square_sum = (design * result.coefficients - points.col(2)).squaredNorm();
  const Eigen::MatrixXd triangle = solver.matrixR().topLeftCorner(terms, terms);
  const Eigen::MatrixXd root =
      solver.colsPermutation() *
      Eigen::MatrixXd(triangle.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(terms, terms)));
  result.inverse = root * root.transpose();
  return result;
}

// Turns the frame so that its normal is that of the polynomial, and moves it onto the polynomial. Returns the
// slope before.
double turn(Frame& frame, const Polynomial& polynomial, double radius) {
  const Eigen::Vector3d slope(-polynomial.coefficients[kX], -polynomial.coefficients[kY], 1);
  const Eigen::Vector3d normal = frame.axes * slope.normalized();
  frame.origin += polynomial.coefficients[kConstant] * radius * frame.axes.col(2);
  const auto rotation = Eigen::Quaterniond::FromTwoVectors(frame.axes.col(2), normal);
  frame.axes = rotation.toRotationMatrix() * frame.axes;
  return slope.head<2>().norm();
}

LocalFit inUnits(const Polynomial& polynomial, const Frame& frame, std::size_t points, double radius) {
  LocalFit fit;
  fit.frame = frame;
  fit.vertices = points;
  const Eigen::VectorXd& c = polynomial.coefficients;
  fit.curvature = {-2 * c[kXX] / radius, -2 * c[kYY] / radius, -c[kXY] / radius};
  const auto freedom = double(points) - double(c.size());
  fit.square_sum = polynomial.square_sum * radius * radius;
  fit.roughness = std::sqrt(fit.square_sum / freedom);
  Eigen::Matrix3Xd derivatives = Eigen::Matrix3Xd::Zero(3, c.size());
  derivatives(0, kXX) = derivatives(1, kYY) = -2 / radius;
  derivatives(2, kXY) = -1 / radius;
  fit.covariance =
      derivatives * polynomial.inverse * derivatives.transpose() * (polynomial.square_sum / freedom);
  return fit;
}

}  // namespace

std::optional<LocalFit> fitSurface(const std::vector<Point>& points, const Frame& frame, double radius,
                                   int degree) {
  if (points.size() < verticesFor(degree)) return std::nullopt;
  Frame turned = frame;
  for (int i = 0; i < kTurns; ++i) {
    const auto polynomial = fitPolynomial(localPoints(points, turned, radius), degree);
    if (!polynomial) return std::nullopt;
    const double slope = turn(turned, *polynomial, radius);
    if (slope < kSameNormal) return inUnits(*polynomial, turned, points.size(), radius);
  }
  return std::nullopt;
}

}  // namespace fsr::mesh
