#include "fsr_pressure_map/view/bent_sheet.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace fsr::view {

namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

// Frame on the sheet. The columns of `axes` are the directions along the row, along the column, and the
// normal.
struct Frame {
  Vector position = Vector::Zero();
  Matrix axes = Matrix::Identity();
};

Matrix crossMatrix(const Vector& v) {
  Matrix result;
  result << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return result;
}

// Moves a frame by a screw motion: a rotation by `turn` [rad] in the frame's own axes while the point moves
// along `path` [m]. Exponential of Murray, Li, Sastry: A Mathematical Introduction to Robotic Manipulation
// (1994), eq. 2.36.
Frame screw(const Frame& from, const Vector& turn, const Vector& path) {
  constexpr double kSeriesBelow = 1e-3;  // [rad]; below it, the neglected terms are under 1e-15
  const double angle = turn.norm();
  const bool small = angle < kSeriesBelow;
  const double squared = angle * angle;
  const double first = small ? 0.5 - squared / 24 : (1 - std::cos(angle)) / squared;
  const double second = small ? 1.0 / 6 - squared / 120 : (angle - std::sin(angle)) / (squared * angle);
  const Matrix cross = crossMatrix(turn);
  const Matrix along = Matrix::Identity() + first * cross + second * cross * cross;
  const Vector axis = angle > 0 ? Vector(turn / angle) : Vector::UnitX();
  return {from.position + from.axes * (along * path),
          from.axes * Eigen::AngleAxisd(angle, axis).toRotationMatrix()};
}

Frame alongRow(const Frame& from, const matrix::Curvature& k, double step) {
  return screw(from, step * Vector(-k.xy, k.x, 0), step * Vector::UnitX());
}

Frame alongColumn(const Frame& from, const matrix::Curvature& k, double step) {
  return screw(from, step * Vector(-k.y, k.xy, 0), step * Vector::UnitY());
}

matrix::Curvature mean(const matrix::Curvature& a, const matrix::Curvature& b) {
  return {0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.xy + b.xy)};
}

// Frames of `count` points in a line, a pitch apart, computed from the line's middle outwards. `curvature(i)`
// is the curvature at point i, `step(frame, curvature, length)` moves a frame by one step.
template <typename CurvatureAt, typename Step>
std::vector<Frame> walk(const Frame& middle, int count, double pitch, CurvatureAt curvature, Step step) {
  std::vector<Frame> frames(std::size_t(count), middle);
  const int low = (count - 1) / 2;  // low = high: the middle point; else the two points beside the middle
  const int high = count / 2;
  if (low != high) {
    const matrix::Curvature between = mean(curvature(low), curvature(high));
    frames[std::size_t(low)] = step(middle, between, -0.5 * pitch);
    frames[std::size_t(high)] = step(middle, between, 0.5 * pitch);
  }
  for (int i = high + 1; i < count; ++i) {
    frames[std::size_t(i)] = step(frames[std::size_t(i - 1)], mean(curvature(i - 1), curvature(i)), pitch);
  }
  for (int i = low - 1; i >= 0; --i) {
    frames[std::size_t(i)] = step(frames[std::size_t(i + 1)], mean(curvature(i + 1), curvature(i)), -pitch);
  }
  return frames;
}

Vector3 plain(const Vector& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

std::vector<TaxelPose> bendSheet(const matrix::Layout& layout, const matrix::Surface& surface) {
  matrix::requireFit(surface, layout.size);
  const int rows = layout.size.rows;
  const int columns = layout.size.columns;
  const auto at = [&](int row, int column) {
    const matrix::TaxelIndex taxel =
        layout.index(static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(column));
    return surface.known() ? surface.at(taxel) : matrix::Curvature{};
  };
  const auto spine = [&](int row) { return mean(at(row, (columns - 1) / 2), at(row, columns / 2)); };
  std::vector<TaxelPose> poses;
  poses.reserve(layout.size.taxels());
  const std::vector<Frame> starts = walk(Frame{}, rows, layout.pitch_y, spine, alongColumn);
  for (int row = 0; row < rows; ++row) {
    const auto along = [&](int column) { return at(row, column); };
    for (const Frame& frame : walk(starts[std::size_t(row)], columns, layout.pitch_x, along, alongRow)) {
      poses.push_back({plain(frame.position), plain(frame.axes.col(2))});
    }
  }
  return poses;
}

}  // namespace fsr::view
