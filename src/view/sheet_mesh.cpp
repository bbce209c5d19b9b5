#include "view/sheet_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fsr::view {

SmoothLayer::Place SmoothLayer::place(double coordinate, int count) {
  const double inside = std::clamp(coordinate, 0.0, double(count - 1));
  const int low = std::min(static_cast<int>(inside), std::max(count - 2, 0));
  return {low, std::min(low + 1, count - 1), inside - low};
}

double SmoothLayer::at(const Place& r, const Place& c) const {
  const double first = value(r.low, c.low) * (1 - c.part) + value(r.low, c.high) * c.part;
  const double second = value(r.high, c.low) * (1 - c.part) + value(r.high, c.high) * c.part;
  const double result = first * (1 - r.part) + second * r.part;
  return std::isnan(result) ? patched(r, c) : result;
}

void SmoothLayer::alongRow(const Place& row, const std::vector<Place>& columns,
                           std::vector<double>& result) const {
  std::vector<double> between(std::size_t{size_.columns});  // interpolated between the two rows
  for (int c = 0; c < size_.columns; ++c) {
    between[std::size_t(c)] = value(row.low, c) * (1 - row.part) + value(row.high, c) * row.part;
  }
  result.resize(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Place& c = columns[i];
    const double blend = between[std::size_t(c.low)] * (1 - c.part) + between[std::size_t(c.high)] * c.part;
    result[i] = std::isnan(blend) ? at(row, c) : blend;
  }
}

// Interpolation if some of the four taxels have no value: NaN if the nearest has none, else from the others.
double SmoothLayer::patched(const Place& r, const Place& c) const {
  if (std::isnan(value(r.part < 0.5 ? r.low : r.high, c.part < 0.5 ? c.low : c.high))) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double sum = 0, weight = 0;
  const auto add = [&](int i, int j, double w) {
    if (std::isnan(value(i, j))) return;
    sum += w * value(i, j);
    weight += w;
  };
  add(r.low, c.low, (1 - r.part) * (1 - c.part));
  add(r.low, c.high, (1 - r.part) * c.part);
  add(r.high, c.low, r.part * (1 - c.part));
  add(r.high, c.high, r.part * c.part);
  return sum / weight;
}

namespace {

// Chords of 1/8 pitch: the relative error of their length is (k s)^2 / 24 = 2.6e-5 at 20/m and 1.25 mm.
constexpr int kAreaFineness = 8;

// Curvature at a point in taxel coordinates, interpolated bilinearly; constant beyond the outer centres.
matrix::Curvature blend(const matrix::Surface& surface, const matrix::Layout& layout, double row,
                        double column) {
  const double r = std::clamp(row, 0.0, layout.size.rows - 1.0);
  const double c = std::clamp(column, 0.0, layout.size.columns - 1.0);
  const int r0 = static_cast<int>(r), c0 = static_cast<int>(c);
  const double dr = r - r0, dc = c - c0;
  matrix::Curvature result;
  const auto add = [&](int i, int j, double w) {
    if (w == 0) return;
    const matrix::Curvature& k = surface.curvature[std::size_t(i) * layout.size.columns + std::size_t(j)];
    result = {result.x + w * k.x, result.y + w * k.y, result.xy + w * k.xy};
  };
  add(r0, c0, (1 - dr) * (1 - dc));
  add(r0, c0 + 1, (1 - dr) * dc);
  add(r0 + 1, c0, dr * (1 - dc));
  add(r0 + 1, c0 + 1, dr * dc);
  return result;
}

// The surface at the vertices of a mesh.
matrix::Surface refined(const matrix::Surface& surface, const matrix::Layout& layout,
                        const matrix::Layout& mesh, int fineness) {
  if (surface.curvature.size() <= 1) return {surface.name, surface.mount, surface.curvature, {}};
  matrix::Surface result;
  result.curvature.reserve(mesh.size.taxels());
  for (std::size_t i = 0; i < mesh.size.taxels(); ++i) {
    const double row = double(mesh.row({i})) / fineness - 0.5;
    const double column = double(mesh.column({i})) / fineness - 0.5;
    result.curvature.push_back(blend(surface, layout, row, column));
  }
  return result;
}

double triangleArea(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  return 0.5 * std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
}

}  // namespace

SheetMesh::SheetMesh(const matrix::Layout& layout, const matrix::Surface& surface, int fineness)
    : layout_(layout), fineness_(std::clamp(fineness, 1, 16)) {
  matrix::requireFit(surface, layout.size);
  matrix::Layout mesh;
  mesh.size = {static_cast<std::uint16_t>(layout.size.rows * fineness_ + 1),
               static_cast<std::uint16_t>(layout.size.columns * fineness_ + 1)};
  mesh.pitch_x = layout.pitch_x / fineness_;
  mesh.pitch_y = layout.pitch_y / fineness_;
  vertices_ = bendSheet(mesh, refined(surface, layout, mesh, fineness_));
  corners_.reserve(layout.size.taxels() * cornersOfTaxel());
  forEachCorner([this](int row, int column) { corners_.push_back(vertices_[vertex(row, column)].position); });
}

// Calls visit(row, column) with the row and column of each corner's vertex, in the order of corners().
template <typename Visit>
void SheetMesh::forEachCorner(Visit visit) const {
  for (std::size_t taxel = 0; taxel < layout_.size.taxels(); ++taxel) {
    const int top = layout_.row({taxel}) * fineness_;
    const int left = layout_.column({taxel}) * fineness_;
    for (int row = top; row < top + fineness_; ++row) {
      for (int column = left; column < left + fineness_; ++column) {
        visit(row, column);
        visit(row, column + 1);
        visit(row + 1, column + 1);
        visit(row, column);
        visit(row + 1, column + 1);
        visit(row + 1, column);
      }
    }
  }
}

void SheetMesh::colourCells(const std::vector<float>& values, const PressureScale& scale,
                            std::vector<Colour>& colours) const {
  colours.clear();
  colours.reserve(corners_.size());
  for (const float value : values) {
    colours.insert(colours.end(), cornersOfTaxel(),
                   std::isnan(value) ? kNoReadingColour : scale.colour(double(value)));
  }
}

void SheetMesh::colourSmoothly(const std::vector<float>& values, const PressureScale& scale,
                               std::vector<Colour>& colours) const {
  const SmoothLayer layer(values, layout_.size);
  std::vector<SmoothLayer::Place> columns;
  for (int column = 0; column <= layout_.size.columns * fineness_; ++column) {
    columns.push_back(layer.column(double(column) / fineness_ - 0.5));
  }
  std::vector<Colour> of_vertex;
  of_vertex.reserve(vertices_.size());
  std::vector<double> along;
  for (int row = 0; row <= layout_.size.rows * fineness_; ++row) {
    layer.alongRow(layer.row(double(row) / fineness_ - 0.5), columns, along);
    for (const double value : along) {
      of_vertex.push_back(std::isnan(value) ? kNoReadingColour : scale.colour(value));
    }
  }
  colours.clear();
  colours.reserve(corners_.size());
  forEachCorner([&](int row, int column) { colours.push_back(of_vertex[vertex(row, column)]); });
}

Vector3 SheetMesh::point(double row, double column, double lift) const {
  const double r = std::clamp((row + 0.5) * fineness_, 0.0, double(layout_.size.rows * fineness_));
  const double c = std::clamp((column + 0.5) * fineness_, 0.0, double(layout_.size.columns * fineness_));
  const int r0 = std::min(static_cast<int>(r), layout_.size.rows * fineness_ - 1);
  const int c0 = std::min(static_cast<int>(c), layout_.size.columns * fineness_ - 1);
  const double dr = r - r0, dc = c - c0;
  Vector3 result;
  const auto add = [&](int i, int j, double w) {
    const TaxelPose& pose = vertices_[vertex(i, j)];
    result.x += w * (pose.position.x + lift * pose.normal.x);
    result.y += w * (pose.position.y + lift * pose.normal.y);
    result.z += w * (pose.position.z + lift * pose.normal.z);
  };
  add(r0, c0, (1 - dr) * (1 - dc));
  add(r0, c0 + 1, (1 - dr) * dc);
  add(r0 + 1, c0, dr * (1 - dc));
  add(r0 + 1, c0 + 1, dr * dc);
  return result;
}

std::vector<double> SheetMesh::areas() const {
  std::vector<double> result(layout_.size.taxels(), 0);
  for (std::size_t i = 0; i < corners_.size(); i += 3) {
    result[i / cornersOfTaxel()] += triangleArea(corners_[i], corners_[i + 1], corners_[i + 2]);
  }
  return result;
}

std::vector<double> taxelAreas(const matrix::Layout& layout, const matrix::Surface& surface) {
  return SheetMesh(layout, surface, kAreaFineness).areas();
}

}  // namespace fsr::view
