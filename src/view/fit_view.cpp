#include "view/fit_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fsr::view {

namespace {

double along(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The camera's place in one direction of the picture, for edges at `low` and `high` (ratios of the depth).
class PictureAxis {
 public:
  PictureAxis(double low, double high) : low_(low), high_(high) {}

  void add(double across, double ahead) {
    most_ = std::max(most_, across - high_ * ahead);
    least_ = std::min(least_, across - low_ * ahead);
  }
  // The most that the camera may be ahead.
  double nearest() const { return (least_ - most_) / (high_ - low_); }
  // Where it then is, in the middle of what is left.
  double place(double ahead) const { return 0.5 * (most_ + high_ * ahead + least_ + low_ * ahead); }

 private:
  double low_, high_;
  double most_ = -std::numeric_limits<double>::infinity();
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::optional<OrbitCamera> fitView(OrbitCamera camera, const std::vector<Vector3>& points, const Lens& lens,
                                   const Window& window) {
  if (points.empty() || !(window.left < window.right) || !(window.bottom < window.top)) return std::nullopt;
  const double c = std::cos(camera.pitch), s = std::sin(camera.pitch);
  const double cy = std::cos(camera.yaw), sy = std::sin(camera.yaw);
  const Vector3 ahead{-cy * c, -sy * c, -s}, right{-sy, cy, 0}, up{-cy * s, -sy * s, c};
  PictureAxis across(window.left * lens.wide, window.right * lens.wide);
  PictureAxis upwards(window.bottom * lens.high, window.top * lens.high);
  double middle = 0;
  for (const Vector3& point : points) {
    const double depth = along(point, ahead);
    middle += depth / static_cast<double>(points.size());
    across.add(along(point, right), depth);
    upwards.add(along(point, up), depth);
  }
  const double place = std::min(across.nearest(), upwards.nearest());
  const double u = across.place(place), v = upwards.place(place);
  camera.distance = middle - place;
  camera.focus = {u * right.x + v * up.x + middle * ahead.x, u * right.y + v * up.y + middle * ahead.y,
                  u * right.z + v * up.z + middle * ahead.z};
  return camera;
}

}  // namespace fsr::view
