#include "fsr_pressure_map/view/bent_sheet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "view/small_sheet.h"

namespace fsr::view {
namespace {

constexpr double kRounding = 1e-14;  // [m], after about 20 chained motions

// Position on a cylinder of curvature k [1/m] whose axis is at `angle` [rad] from the y axis: arc length
// across the axis, straight along it.
Vector3 onCylinder(const matrix::Position& flat, double k, double angle) {
  const double across = flat.x * std::cos(angle) + flat.y * std::sin(angle);
  const double along = -flat.x * std::sin(angle) + flat.y * std::cos(angle);
  const double sideways = std::sin(k * across) / k;
  return {sideways * std::cos(angle) - along * std::sin(angle),
          sideways * std::sin(angle) + along * std::cos(angle), (std::cos(k * across) - 1) / k};
}

void expectNear(const Vector3& a, const Vector3& b, std::size_t taxel) {
  EXPECT_NEAR(a.x, b.x, kRounding) << "taxel " << taxel;
  EXPECT_NEAR(a.y, b.y, kRounding) << "taxel " << taxel;
  EXPECT_NEAR(a.z, b.z, kRounding) << "taxel " << taxel;
}

double distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

TEST(BentSheet, IsFlatOnAFlatOrUnknownSurface) {
  for (const matrix::Surface& surface : {uniform({}), matrix::Surface{}}) {
    const auto poses = bendSheet(kLayout, surface);
    ASSERT_EQ(poses.size(), 70u);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const matrix::Position flat = kLayout.position({i});
      expectNear(poses[i].position, {flat.x, flat.y, 0}, i);
      expectNear(poses[i].normal, {0, 0, 1}, i);
    }
  }
}

TEST(BentSheet, FollowsACylinderOfAnyAxisByArcLength) {
  for (const double k : {20.0, 1 / 0.13, -14.3}) {
    for (const double angle : {0.0, M_PI / 2, 0.3, -1.0}) {
      const double c = std::cos(angle), s = std::sin(angle);
      const auto poses = bendSheet(kLayout, uniform({k * c * c, k * s * s, k * c * s}));
      for (std::size_t i = 0; i < poses.size(); ++i) {
        expectNear(poses[i].position, onCylinder(kLayout.position({i}), k, angle), i);
      }
    }
  }
}

TEST(BentSheet, PositiveCurvatureFallsAwayFromTheLoadedFace) {
  const auto outside = bendSheet(kLayout, uniform({20, 0, 0}));
  EXPECT_LT(outside.front().position.z, -0.01);
  EXPECT_LT(outside.front().normal.x, -0.5);  // column 0 lies at negative x and looks outwards
  const auto inside = bendSheet(kLayout, uniform({-20, 0, 0}));
  EXPECT_GT(inside.front().position.z, 0.01);
  EXPECT_GT(inside.front().normal.x, 0.5);
}

TEST(BentSheet, LiesExactlyOnASphere) {
  const double radius = 0.08;
  const auto poses = bendSheet(kLayout, uniform({1 / radius, 1 / radius, 0}));
  for (const TaxelPose& pose : poses) {
    EXPECT_NEAR(distance(pose.position, {0, 0, -radius}), radius, kRounding);
    EXPECT_NEAR(pose.normal.z, (pose.position.z + radius) / radius, 1e-12);
  }
}

TEST(BentSheet, KeepsLengthsAlongRowsIfCurvatureDiffersBetweenTaxels) {
  matrix::Surface surface;
  for (std::size_t i = 0; i < 70; ++i) surface.curvature.push_back({5.0 + double(i % 10), -2.0, 0});
  const auto poses = bendSheet(kLayout, surface);
  for (std::size_t row = 0; row < 7; ++row) {
    for (std::size_t column = 0; column + 1 < 10; ++column) {
      const double k = 5.5 + double(column);  // mean of the two taxels
      const double chord = 2 * std::sin(0.5 * k * kLayout.pitch_x) / k;
      const std::size_t i = row * 10 + column;
      EXPECT_NEAR(distance(poses[i].position, poses[i + 1].position), chord, kRounding);
    }
  }
}

TEST(BentSheet, OneValueForAllEqualsTheSameValueForEach) {
  const matrix::Curvature saddle{12, -7, 3};
  matrix::Surface each;
  each.curvature.assign(70, saddle);
  const auto a = bendSheet(kLayout, uniform(saddle));
  const auto b = bendSheet(kLayout, each);
  for (std::size_t i = 0; i < 70; ++i) expectNear(a[i].position, b[i].position, i);
}

TEST(BentSheet, ASaddleRisesAlongOneAxisAndFallsAlongTheOther) {
  const auto poses = bendSheet(kLayout, uniform({15, -15, 0}));
  EXPECT_LT(poses[kLayout.index(3, 0).value].position.z, 0);
  EXPECT_GT(poses[kLayout.index(0, 5).value].position.z, 0);
}

TEST(BentSheet, TwistLiftsOppositeCorners) {
  const auto poses = bendSheet(kLayout, uniform({0, 0, 5}));
  EXPECT_LT(poses[kLayout.index(0, 0).value].position.z, -1e-3);  // z = -xy x y near the middle
  EXPECT_LT(poses[kLayout.index(6, 9).value].position.z, -1e-3);
  EXPECT_GT(poses[kLayout.index(0, 9).value].position.z, 1e-3);
  EXPECT_GT(poses[kLayout.index(6, 0).value].position.z, 1e-3);
}

TEST(BentSheet, RefusesASurfaceOfAnotherMatrix) {
  matrix::Surface surface;
  surface.name = "limb";
  surface.curvature.resize(64);
  EXPECT_THROW(bendSheet(kLayout, surface), settings::InputError);
}

}  // namespace
}  // namespace fsr::view
