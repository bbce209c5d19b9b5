#include "view/fit_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace {

using fsr::view::fitView;
using fsr::view::Lens;
using fsr::view::OrbitCamera;
using fsr::view::Vector3;
using fsr::view::Window;

constexpr Lens kLens{0.4, 0.6};

// Place in the picture, computed by turning the point about z and then about the picture's horizontal axis.
std::pair<double, double> seen(const Vector3& point, const OrbitCamera& camera) {
  const double x = point.x - camera.focus.x, y = point.y - camera.focus.y, z = point.z - camera.focus.z;
  const double toward = x * std::cos(camera.yaw) + y * std::sin(camera.yaw);
  const double right = -x * std::sin(camera.yaw) + y * std::cos(camera.yaw);
  const double up = z * std::cos(camera.pitch) - toward * std::sin(camera.pitch);
  const double depth = camera.distance - toward * std::cos(camera.pitch) - z * std::sin(camera.pitch);
  return {right / depth / kLens.wide, up / depth / kLens.high};
}

std::vector<Vector3> sheet(double wide, double high) {
  return {{-wide, -high, 0}, {wide, -high, 0}, {-wide, high, -0.01}, {wide, high, -0.01}, {0, 0, 0.02}};
}

TEST(FitView, FillsTheWindowInOneDirectionAndStaysWithinItInTheOther) {
  for (const auto& [wide, high] : {std::pair{0.05, 0.035}, {0.05, 0.08}, {0.02, 0.015}, {0.3, 0.01}}) {
    for (const Window& window : {Window{}, Window{-0.3, 0.95, -0.9, 0.9}, Window{-0.9, 0.9, -0.95, -0.1}}) {
      OrbitCamera camera;
      camera.yaw = 4.35;
      camera.pitch = 0.95;
      const auto points = sheet(wide, high);
      const auto fitted = fitView(camera, points, kLens, window);
      ASSERT_TRUE(fitted);
      EXPECT_EQ(fitted->yaw, camera.yaw);
      EXPECT_EQ(fitted->pitch, camera.pitch);
      Window found{1, -1, 1, -1};
      for (const Vector3& point : points) {
        const auto [x, y] = seen(point, *fitted);
        found = {std::min(found.left, x), std::max(found.right, x), std::min(found.bottom, y),
                 std::max(found.top, y)};
      }
      EXPECT_GE(found.left, window.left - 1e-9);
      EXPECT_LE(found.right, window.right + 1e-9);
      EXPECT_GE(found.bottom, window.bottom - 1e-9);
      EXPECT_LE(found.top, window.top + 1e-9);
      const double gap = std::min(window.right - window.left - (found.right - found.left),
                                  window.top - window.bottom - (found.top - found.bottom));
      EXPECT_NEAR(gap, 0, 1e-9) << "as near as possible";
    }
  }
}

TEST(FitView, GivesNothingWithoutPointsOrWithoutAWindow) {
  EXPECT_FALSE(fitView({}, {}, kLens, {}));
  EXPECT_FALSE(fitView({}, sheet(0.1, 0.1), kLens, {0.5, 0.5, -1, 1}));
  EXPECT_FALSE(fitView({}, sheet(0.1, 0.1), kLens, {-1, 1, 0.2, -0.2}));
}

}  // namespace
