#include "mesh/mesh_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <limits>
#include <sstream>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/surface_file.h"
#include "settings/number_text.h"
#include "settings/text.h"
#include "statistics/samples.h"

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

namespace {

std::string text(double value, int digits) {
  return settings::roundedText(value, digits);
}

std::string listText(const Point& point) {
  return text(point.x(), 6) + ", " + text(point.y(), 6) + ", " + text(point.z(), 6);
}

std::string millimetres(double low, double high) {
  const std::string first = text(1e3 * low, 3), last = text(1e3 * high, 3);
  return (first == last ? first : first + " to " + last) + " mm";
}

const char* sideText(const SheetPlace& place) {
  return place.along_normals ? "along the normals of the triangles (--side outside)"
                             : "against the normals of the triangles (--side inside)";
}

template <typename Of>
std::vector<double> ofTaxels(const LaidSheet& sheet, Of of) {
  std::vector<double> values;
  for (const SheetFit& taxel : sheet.taxels) values.push_back(of(taxel));
  return values;
}

std::string fitText(const LaidSheet& sheet) {
  const Spread radius = spread(ofTaxels(sheet, [](const SheetFit& taxel) { return taxel.radius; }));
  const Spread vertices =
      spread(ofTaxels(sheet, [](const SheetFit& taxel) { return double(taxel.fit.vertices); }));
  const Spread rough = spread(ofTaxels(sheet, [](const SheetFit& taxel) { return taxel.fit.roughness; }));
  return "polynomials of degree " + std::to_string(sheet.degree) + " fitted to the " + text(vertices.low, 6) +
         " to " + text(vertices.high, 6) + " vertices within " + millimetres(radius.low, radius.high) +
         " of each taxel; roughness " + text(1e3 * rough.median, 2) + " mm";
}

// Convex, concave, saddle ... by the principal curvatures.
std::string shapeText(const MeshSurface& surface) {
  const auto [low, high] = std::minmax_element(surface.strongest.begin(), surface.strongest.end());
  if (*low > 0) return "convex towards the load at every taxel, as on a limb phantom (curvature > 0)";
  if (*high < 0) return "concave towards the load at every taxel, as in a socket (curvature < 0)";
  return "convex towards the load at some taxels and concave at others";
}

void addValues(std::ostringstream& out, const std::string& key, const matrix::Layout& layout,
               const std::function<double(std::size_t)>& value) {
  out << "  " << key << ":";
  for (std::size_t i = 0; i < layout.size.taxels(); ++i) {
    const bool row_begins = i % layout.size.columns == 0;
    const double rounded = std::round(1e4 * value(i)) / 1e4 + 0.0;  // -0 becomes 0
    out << (row_begins ? (i == 0 ? "\n    [" : ",\n     ") : ", ") << settings::numberText(rounded);
  }
  out << "]\n";
}

// A point [m] or direction, rounded to 1e-6.
std::string vectorText(const Point& vector) {
  std::string result;
  for (const double value : {vector.x(), vector.y(), vector.z()})
    result += (result.empty() ? "[" : ", ") + settings::numberText(std::round(1e6 * value) / 1e6 + 0.0);
  return result + "]";
}

void addRow(std::ostringstream& out, const std::string& what, const Spread& values) {
  out << std::left << std::setw(44) << what << std::right;
  for (const double value : {values.low, values.median, values.high})
    out << std::setw(10) << settings::fixedText(std::round(1e3 * value) / 1e3 + 0.0, 3);
  out << '\n';
}

std::string pitchText(const PitchError& error) {
  std::string result = "pitch between neighbouring rows: off by at most " +
                       settings::fixedText(1e2 * std::abs(error.largest), 2) + " %";
  if (std::abs(error.largest) > kLargestPitchError) {
    result += " (rows " + std::to_string(error.row) + " and " + std::to_string(error.row + 1) + ", column " +
              std::to_string(error.column) + ")\nWarning: this surface bends in two directions at once. " +
              "A sheet that cannot stretch wrinkles on it, and taxels lie elsewhere than computed.";
  }
  return result;
}

}  // namespace

std::string surfaceFileText(const MeshSurface& surface, const SheetPlace& place, const MeshOrigin& origin) {
  std::ostringstream out;
  out << "# Matrix on a mesh: " << origin.mesh << " [" << origin.unit.name
      << "], made by surface_from_mesh.\n"
      << "# Middle of the matrix at " << listText(origin.at) << ", rows along "
      << listText(origin.row_direction) << ", +z " << sideText(place) << ".\n"
      << "# Pitch " << text(1e3 * place.layout.pitch_x, 4) << " x " << text(1e3 * place.layout.pitch_y, 4)
      << " mm; " << fitText(surface.sheet) << ".\n"
      << "surface: " << settings::quotedText(surface.surface.name) << "\ntaxels:  # "
      << matrix::sizeText(place.layout.size) << ", row-major [1/m]\n";
  const auto& curvature = surface.surface.curvature;
  addValues(out, "x", place.layout, [&](std::size_t i) { return curvature[i].x; });
  addValues(out, "y", place.layout, [&](std::size_t i) { return curvature[i].y; });
  addValues(out, "xy", place.layout, [&](std::size_t i) { return curvature[i].xy; });
  addValues(out, "deviation", place.layout, [&](std::size_t i) { return surface.surface.deviation[i]; });
  const Frame& middle = surface.sheet.middle;
  out << "mesh:  # where the matrix lies on it, for rviz\n"
      << "  file: " << settings::quotedText(origin.path) << "\n"
      << "  unit: " << settings::numberText(origin.unit.length) << "  # [m]\n"
      << "  middle: " << vectorText(middle.origin) << "  # [m]\n"
      << "  row: " << vectorText(middle.axes.col(0)) << "\n"
      << "  normal: " << vectorText(middle.axes.col(2)) << "\n";
  return out.str();
}

std::string surfaceReport(const MeshSurface& surface, const SheetPlace& place, const MeshOrigin& origin) {
  std::ostringstream out;
  const auto magnitude =
      ofTaxels(surface.sheet, [](const SheetFit& taxel) { return taxel.fit.curvature.xy; });
  out << origin.mesh << ": " << origin.triangles << " triangles, " << origin.vertices << " vertices, unit "
      << origin.unit.name << "\n"
      << matrix::sizeText(place.layout.size) << " matrix, its middle "
      << text(1e3 * surface.sheet.distance, 2) << " mm from --at\n"
      << "+z " << sideText(place) << ": the sheet is " << shapeText(surface) << "\n"
      << fitText(surface.sheet) << "\n\n"
      << std::left << std::setw(44) << "[1/m]" << std::right << std::setw(10) << "lowest" << std::setw(10)
      << "median" << std::setw(10) << "highest" << '\n';
  addRow(out, "principal curvature of largest magnitude", spread(surface.strongest));
  addRow(out, "other principal curvature", spread(surface.weakest));
  addRow(out, "twist (xy)", spread(magnitude));
  addRow(out, "deviation", spread(surface.surface.deviation));
  out << '\n' << pitchText(surface.pitch_error) << '\n';
  return out.str();
}

}  // namespace fsr::mesh
