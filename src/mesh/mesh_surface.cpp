#include "mesh/mesh_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/surface_file.h"
#include "settings/number_text.h"
#include "statistics/median.h"

namespace fsr::mesh {

namespace {

constexpr double kLargestMesh = 10;  // diameter from which on the unit must be wrong [m]

std::string lengthText(double length) {
  return settings::roundedText(1e3 * length, 3) + " mm";
}

void requireSize(const Mesh& mesh, const matrix::Layout& layout) {
  const double diameter = mesh.diameter();
  const double sheet =
      std::max((layout.size.columns - 1) * layout.pitch_x, (layout.size.rows - 1) * layout.pitch_y);
  if (diameter > kLargestMesh) {
    throw settings::InputError("the mesh is " + settings::roundedText(diameter, 3) +
                               " m across, but should be less than 10 m; check --units (mm, cm, m or inch)");
  }
  if (diameter < sheet) {
    throw settings::InputError("the mesh is " + lengthText(diameter) + " across, but the matrix is " +
                               lengthText(sheet) +
                               " long; check --units (mm, cm, m or inch), and the size of the matrix");
  }
}

std::string nameOf(const matrix::Layout& layout, std::size_t taxel) {
  return "row " + std::to_string(layout.row({taxel})) + ", column " + std::to_string(layout.column({taxel}));
}

// Direction of the principal curvature of largest magnitude: the derivative of this curvature by x, y and xy
// is (d_x^2, d_y^2, 2 d_x d_y).
struct Principal {
  double strongest = 0, weakest = 0, deviation = 0;
};

Principal principal(const LocalFit& fit) {
  Eigen::Matrix2d tensor;
  tensor << fit.curvature.x, fit.curvature.xy, fit.curvature.xy, fit.curvature.y;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(tensor);
  const int strong = std::abs(solver.eigenvalues()[0]) > std::abs(solver.eigenvalues()[1]) ? 0 : 1;
  const Eigen::Vector2d d = solver.eigenvectors().col(strong);
  const Eigen::Vector3d derivative(d.x() * d.x(), d.y() * d.y(), 2 * d.x() * d.y());
  return {solver.eigenvalues()[strong], solver.eigenvalues()[1 - strong],
          std::sqrt(std::max(0.0, derivative.dot(fit.covariance * derivative)))};
}

void requirePlausible(const Principal& taxel, const std::string& name) {
  if (std::abs(taxel.strongest) > matrix::kMaxCurvature) {
    throw settings::InputError(
        "the mesh has a curvature of " + settings::roundedText(taxel.strongest, 4) + " 1/m at the taxel at " +
        name +
        ", but must be bent by at most 100 1/m (a radius of 10 mm); check --units (mm, cm, m or inch), and "
        "whether the matrix lies over an edge");
  }
  if (!(taxel.deviation <= matrix::kMaxCurvature)) {
    throw settings::InputError("the mesh is so rough that the curvature at the taxel at " + name +
                               " is known to " + settings::roundedText(taxel.deviation, 3) +
                               " 1/m only; smooth the mesh, or give a larger --fit-radius");
  }
}

// The distance along the surface, from that through space: an arc of curvature k is longer than its chord by
// the share (k chord)^2 / 24.
double distanceAlong(const LocalFit& a, const LocalFit& b) {
  const double chord = (a.frame.origin - b.frame.origin).norm();
  const double bend = 0.5 * (a.curvature.y + b.curvature.y) * chord;
  return chord * (1 + bend * bend / 24);
}

PitchError pitchError(const LaidSheet& sheet, const matrix::Layout& layout) {
  PitchError worst;
  const std::size_t columns = layout.size.columns;
  for (std::size_t i = 0; i + columns < sheet.taxels.size(); ++i) {
    const double error =
        distanceAlong(sheet.taxels[i].fit, sheet.taxels[i + columns].fit) / layout.pitch_y - 1;
    if (std::abs(error) > std::abs(worst.largest)) worst = {error, i / columns, i % columns};
  }
  return worst;
}

}  // namespace

MeshUnit meshUnit(const std::string& name) {
  for (const MeshUnit& unit : {MeshUnit{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}, {"inch", 0.0254}}) {
    if (unit.name == name) return unit;
  }
  throw settings::InputError("--units is \"" + name +
                             "\", but must be mm, cm, m or inch: the unit of the mesh's coordinates");
}

MeshSurface surfaceFromMesh(const Mesh& mesh, const SheetPlace& place, const std::string& name) {
  requireSize(mesh, place.layout);
  MeshSurface result;
  result.sheet = laySheet(mesh, place);
  result.surface.name = name;
  for (std::size_t i = 0; i < result.sheet.taxels.size(); ++i) {
    const LocalFit& fit = result.sheet.taxels[i].fit;
    const Principal taxel = principal(fit);
    requirePlausible(taxel, nameOf(place.layout, i));
    result.surface.curvature.push_back(fit.curvature);
    result.surface.deviation.push_back(std::hypot(taxel.deviation, result.sheet.bias));
    result.strongest.push_back(taxel.strongest);
    result.weakest.push_back(taxel.weakest);
  }
  result.pitch_error = pitchError(result.sheet, place.layout);
  return result;
}

Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {values.front(), statistics::upperMedian(values), values.back()};
}

}  // namespace fsr::mesh
