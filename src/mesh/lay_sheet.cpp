#include "mesh/lay_sheet.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

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

namespace {

constexpr double kStepShare = 0.2;  // largest step of the walk, as a share of the radius of the fits
constexpr double kGrowth = 1.25;    // of the radius where there are too few vertices
constexpr double kSteepest = 0.1;   // smallest part of the row's direction within the surface
constexpr double kOnEdge = 1e-9;    // distance from a triangle's edge that counts as inside [m]

std::string millimetres(double length) {
  return settings::roundedText(1e3 * length, 3) + " mm";
}

// What is wrong at a point of the mesh; the caller adds which taxel it is.
struct NoSurface {
  std::string reason;
};

// Mean over the taxels of the variance of curvature x and y.
double meanVariance(const std::vector<SheetFit>& taxels) {
  double sum = 0;
  for (const SheetFit& taxel : taxels) sum += taxel.fit.covariance.topLeftCorner<2, 2>().trace();
  return sum / (2 * double(taxels.size()));
}

// Mean over the taxels of the squared bias of curvature x and y against fits of a higher degree. For least
// squares, the variance of the difference of two nested fits is the difference of their variances.
double squaredBias(const std::vector<SheetFit>& taxels, const std::vector<SheetFit>& higher) {
  double sum = 0;
  for (std::size_t i = 0; i < taxels.size(); ++i) {
    const matrix::Curvature &a = taxels[i].fit.curvature, &b = higher[i].fit.curvature;
    sum += (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
  }
  return std::max(0.0, sum / (2 * double(taxels.size())) - (meanVariance(higher) - meanVariance(taxels)));
}

class SheetLayer {
 public:
  SheetLayer(const Mesh& mesh, const SheetPlace& place)
      : mesh_(mesh),
        place_(place),
        finder_(mesh),
        radius_(place.radius.value_or(std::max(place.layout.pitch_x, place.layout.pitch_y))) {}

  LaidSheet lay() {
    const int rows = place_.layout.size.rows;
    const int columns = place_.layout.size.columns;
    const Start middle = start();
    sheet_.middle = middle.fit.frame;
    sheet_.taxels.resize(place_.layout.size.taxels());
    patches_.resize(sheet_.taxels.size());
    const double y = place_.layout.pitch_y, x = place_.layout.pitch_x;
    const auto visit_row = [&](int row, const Start& on_column) {
      const auto visit_taxel = [&](int column, const Start& at) { keep(row, column, at); };
      walk(on_column, 0, x, columns, visit_taxel,
           [&](int column) { return "row " + std::to_string(row) + ", column " + std::to_string(column); });
    };
    walk(middle, 1, y, rows, visit_row,
         [&](int row) { return "row " + std::to_string(row) + ", column " + std::to_string(columns / 2); });
    chooseDegree();
    return sheet_;
  }

 private:
  // A frame on the mesh with its surface, and a vertex close to it.
  struct Start {
    LocalFit fit;
    std::uint32_t vertex = 0;
  };
  struct Patch {
    std::vector<std::uint32_t> vertices;
    double radius = 0;
  };

  std::vector<Point> pointsOf(const Patch& patch) const {
    std::vector<Point> points;
    points.reserve(patch.vertices.size());
    for (const std::uint32_t vertex : patch.vertices) points.push_back(mesh_.vertices[vertex]);
    return points;
  }

  // The vertices around a point, enough of them for a fit.
  Patch patchAt(const Point& point, std::uint32_t vertex) {
    Patch patch;
    for (patch.radius = radius_; patch.radius <= kLargestGrowth * radius_ * (1 + 1e-9);
         patch.radius *= kGrowth) {
      patch.vertices = finder_.patch(point, patch.radius, vertex);
      if (patch.vertices.size() >= verticesFor(kLowestDegree)) return patch;
    }
    throw NoSurface{"has only " + std::to_string(patch.vertices.size()) + " vertices of the mesh within " +
                    millimetres(kLargestGrowth * radius_) + ", but a fit needs " +
                    std::to_string(verticesFor(kLowestDegree))};
  }

  // The surface around `frame`.
  Start settle(const Frame& frame, std::uint32_t near) {
    Start result;
    result.vertex = finder_.closestVertex(frame.origin, near);
    const Patch patch = patchAt(frame.origin, result.vertex);
    const auto fit = fitSurface(pointsOf(patch), frame, patch.radius, kLowestDegree);
    if (!fit) throw NoSurface{"lies where the mesh has no smooth surface to fit"};
    result.fit = *fit;
    return result;
  }

  // Mean normal of the triangles that have a corner in the patch.
  Point normalOf(const Patch& patch) const {
    Point sum = Point::Zero();
    double area = 0;
    for (const std::uint32_t vertex : patch.vertices) {
      for (std::uint32_t i = mesh_.first[vertex]; i < mesh_.first[vertex + 1]; ++i) {
        const Point normal = areaNormal(mesh_, mesh_.triangles[mesh_.around[i]]);
        sum += normal;
        area += normal.norm();
      }
    }
    if (sum.norm() < 0.2 * area) {
      throw settings::InputError(
          "the triangles around --at have no common side: their normals point in opposite directions; repair "
          "the mesh (in most programs \"recalculate normals\")");
    }
    return place_.along_normals ? Point(sum.normalized()) : Point(-sum.normalized());
  }

  Start start() {
    const MeshPoint closest = closestPoint(mesh_, place_.at);
    sheet_.distance = closest.distance;
    if (closest.distance > kLargestDistance) {
      throw settings::InputError("--at is " + millimetres(closest.distance) +
                                 " from the mesh, but must be on it or at most 5 mm away; check --at and "
                                 "--units");
    }
    try {
      const std::uint32_t vertex =
          finder_.closestVertex(closest.point, mesh_.triangles[closest.triangle].front());
      Frame frame;
      frame.origin = closest.point;
      frame.axes = axesFor(normalOf(patchAt(closest.point, vertex)));
      Start result = settle(frame, vertex);
      // The row's direction is projected once more, onto the plane of the fit.
      result.fit.frame.axes = axesFor(result.fit.frame.axes.col(2));
      return settle(result.fit.frame, vertex);
    } catch (const NoSurface& none) {
      throw settings::InputError("the middle of the matrix " + none.reason +
                                 "; move --at, or give a mesh "
                                 "with shorter edges or a larger --fit-radius");
    }
  }

  Eigen::Matrix3d axesFor(const Point& normal) const {
    const Point direction = place_.row_direction.normalized();
    const Point along = direction - direction.dot(normal) * normal;
    if (!(along.norm() >= kSteepest)) {
      throw settings::InputError(
          "--row-direction is within 6 degrees of the surface's normal at --at, but must be along the "
          "surface");
    }
    Eigen::Matrix3d axes;
    axes.col(0) = along.normalized();
    axes.col(1) = normal.cross(axes.col(0));
    axes.col(2) = normal;
    return axes;
  }

  // Moves a frame by `length` along its axis 0 (row) or 1 (column).
  Start move(const Start& from, int axis, double length) {
    const int steps = std::max(1, int(std::ceil(std::abs(length) / (kStepShare * radius_))));
    Start at = from;
    for (int i = 0; i < steps; ++i) {
      const double step = length / steps;
      const matrix::Curvature& k = at.fit.curvature;
      const double bend = axis == 0 ? k.x : k.y;
      Frame next = at.fit.frame;
      // A surface of positive curvature falls away from the normal.
      next.origin += step * next.axes.col(axis) - 0.5 * bend * step * step * next.axes.col(2);
      at = settle(next, at.vertex);
    }
    return at;
  }

  // Visits `count` points in a line, a pitch apart, from the line's middle outwards. `name(i)` names the
  // taxel at point i.
  void walk(const Start& middle, int axis, double pitch, int count,
            const std::function<void(int, const Start&)>& visit,
            const std::function<std::string(int)>& name) {
    for (const int sign : {1, -1}) {
      const bool odd = count % 2 == 1;
      Start at = middle;
      for (int i = sign > 0 ? count / 2 : (count - 1) / 2; i >= 0 && i < count; i += sign) {
        const bool first = i == (sign > 0 ? count / 2 : (count - 1) / 2);
        const double length = first ? (odd ? 0 : 0.5 * pitch) : pitch;
        try {
          if (length > 0) at = move(at, axis, sign * length);
          if (first && odd && sign < 0) continue;  // the middle was visited
          visit(i, at);
        } catch (const NoSurface& none) {
          throw settings::InputError(
              "the taxel at " + name(i) + " " + none.reason +
              "; move --at or turn --row-direction so that the whole matrix lies on the "
              "mesh");
        }
      }
    }
  }

  // Whether a triangle of the patch is above or below the frame's origin.
  bool isCovered(const Frame& frame, const Patch& patch) const {
    const auto flat = [&](std::uint32_t vertex) {
      return Eigen::Vector2d((frame.axes.transpose() * (mesh_.vertices[vertex] - frame.origin)).head<2>());
    };
    const auto side = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      return (a.x() * b.y() - a.y() * b.x()) / std::max((b - a).norm(), kOnEdge);  // distance from the edge
    };
    for (const std::uint32_t vertex : patch.vertices) {
      for (std::uint32_t i = mesh_.first[vertex]; i < mesh_.first[vertex + 1]; ++i) {
        const auto& [a, b, c] = mesh_.triangles[mesh_.around[i]];
        const std::array<double, 3> sides = {side(flat(a), flat(b)), side(flat(b), flat(c)),
                                             side(flat(c), flat(a))};
        const auto [low, high] = std::minmax_element(sides.begin(), sides.end());
        if (*low >= -kOnEdge || *high <= kOnEdge) return true;
      }
    }
    return false;
  }

  void keep(int row, int column, const Start& at) {
    const std::size_t taxel =
        place_.layout.index(static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(column)).value;
    patches_[taxel] = patchAt(at.fit.frame.origin, at.vertex);
    if (!isCovered(at.fit.frame, patches_[taxel])) throw NoSurface{"is beside the mesh or in a hole of it"};
    sheet_.taxels[taxel] = {at.fit, patches_[taxel].radius};
  }

  // All taxels with polynomials of one degree; none where one of them cannot be fitted.
  std::vector<SheetFit> fitAll(int degree) const {
    std::vector<SheetFit> taxels = sheet_.taxels;
    for (std::size_t i = 0; i < taxels.size(); ++i) {
      const auto fit = fitSurface(pointsOf(patches_[i]), taxels[i].fit.frame, patches_[i].radius, degree);
      if (!fit) return {};
      taxels[i].fit = *fit;
    }
    return taxels;
  }

  void chooseDegree() {
    std::vector<std::vector<SheetFit>> candidates;
    for (int degree = kLowestDegree; degree <= kHighestDegree; ++degree) {
      candidates.push_back(fitAll(degree));
      if (candidates.back().empty()) candidates.pop_back();
      if (candidates.size() != std::size_t(degree - kLowestDegree + 1)) break;
    }
    if (candidates.empty()) return;  // the fits of the walk stay
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double bias = squaredBias(candidates[i], candidates.back());
      const double error = bias + meanVariance(candidates[i]);
      if (!(error < best)) continue;
      best = error;
      sheet_.taxels = candidates[i];
      sheet_.degree = kLowestDegree + int(i);
      sheet_.bias = std::sqrt(bias);
    }
  }

  const Mesh& mesh_;
  const SheetPlace& place_;
  PatchFinder finder_;
  double radius_;
  LaidSheet sheet_;
  std::vector<Patch> patches_;  // of the taxels
};

}  // namespace

LaidSheet laySheet(const Mesh& mesh, const SheetPlace& place) {
  return SheetLayer(mesh, place).lay();
}

}  // namespace fsr::mesh
