#include "mesh/mesh_surface_text.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <limits>
#include <sstream>

#include "fsr_pressure_map/matrix/layout.h"
#include "settings/number_text.h"
#include "settings/yaml_text.h"

namespace fsr::mesh {

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
