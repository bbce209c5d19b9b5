// Meshes of surfaces whose curvature is known by a formula, with edges of 1 mm.

#include "mesh/mesh_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "mesh/example_meshes.h"
#include "support/holds.h"

namespace fsr::mesh {
namespace {

using test_support::kRadius;
using test_support::MeshOptions;
using test_support::triangles;

constexpr double kTolerance = 0.002;  // of the principal curvature of largest magnitude
constexpr double kDegree = M_PI / 180;

SheetPlace place(const Point& at, const Point& row_direction) {
  SheetPlace result;
  result.layout.size = {7, 10};
  result.at = at;
  result.row_direction = row_direction;
  return result;
}

void expectCurvature(const matrix::Curvature& got, const matrix::Curvature& right, double tolerance) {
  EXPECT_NEAR(got.x, right.x, tolerance);
  EXPECT_NEAR(got.y, right.y, tolerance);
  EXPECT_NEAR(got.xy, right.xy, tolerance);
}

TEST(MeshSurface, ACylinderBendsAlongTheRowsByTheInverseOfItsRadius) {
  for (const double radius : {0.03, 0.05, 0.13}) {
    const Mesh mesh = weld(triangles(test_support::cylinder(radius)));
    const MeshSurface surface = surfaceFromMesh(mesh, place({radius, 0, 0}, {0, 1, 0}), "c");
    for (const matrix::Curvature& taxel : surface.surface.curvature)
      expectCurvature(taxel, {1 / radius, 0, 0}, kTolerance / radius);
    EXPECT_LT(std::abs(surface.pitch_error.largest), 1e-3);
  }
}

// Euler: in a direction at the angle a to the circumference, the curvature is cos^2 a / R. With the rows
// turned towards +z by a, the circumference has the direction (cos a, -sin a) in the matrix frame, K = c c^T
// / R.
TEST(MeshSurface, ObliqueRowsOnACylinderTwist) {
  const double radius = 0.05, a = 30 * kDegree, k = 1 / radius;
  const Mesh mesh = weld(triangles(test_support::cylinder(radius), {0.075, 0.075}));
  const MeshSurface surface =
      surfaceFromMesh(mesh, place({radius, 0, 0}, {0, std::cos(a), std::sin(a)}), "c");
  for (const matrix::Curvature& taxel : surface.surface.curvature) {
    expectCurvature(
        taxel, {k * std::cos(a) * std::cos(a), k * std::sin(a) * std::sin(a), -k * std::sin(a) * std::cos(a)},
        kTolerance * k);
  }
}

TEST(MeshSurface, TheOtherSideOfACylinderIsConcave) {
  const double radius = 0.05;
  const Mesh mesh = weld(triangles(test_support::cylinder(radius)));
  SheetPlace inside = place({radius, 0, 0}, {0, 1, 0});
  inside.along_normals = false;
  const MeshSurface surface = surfaceFromMesh(mesh, inside, "wall");
  for (const matrix::Curvature& taxel : surface.surface.curvature)
    expectCurvature(taxel, {-1 / radius, 0, 0}, kTolerance / radius);
}

// Unrolled, a cone is a plane with the apex as a point. A taxel at (x, y) of the sheet, whose middle is
// `slant` from the apex, is s = |(x, slant + y)| from the apex, and the circle through it has the direction
// c = (slant + y, -x) / s. The curvature around is 1 / (s tan(half angle)), that along is 0.
TEST(MeshSurface, AConeBendsEachTaxelByItsDistanceFromTheApex) {
  const double half_angle = 20 * kDegree, slant = 0.150;
  const Mesh mesh = weld(triangles(test_support::cone(half_angle, slant), {0.075, 0.055}));
  const SheetPlace on_cone =
      place({slant * std::sin(half_angle), 0, slant * std::cos(half_angle)}, {0, 1, 0});
  const MeshSurface surface = surfaceFromMesh(mesh, on_cone, "cone");
  for (std::size_t i = 0; i < 70; ++i) {
    const auto [x, y] = on_cone.layout.position({i});
    const double s = std::hypot(x, slant + y), k = 1 / (s * std::tan(half_angle));
    const double cx = (slant + y) / s, cy = -x / s;
    expectCurvature(surface.surface.curvature[i], {k * cx * cx, k * cy * cy, k * cx * cy}, kTolerance * k);
  }
  EXPECT_LT(std::abs(surface.pitch_error.largest), 1e-3);
}

// Rows are great circles, and so is the middle column: at the angle a = 0.045 / R from it, neighbouring rows
// are nearer by the factor cos a.
TEST(MeshSurface, ASphereBendsBothWaysAndItsRowsConverge) {
  const double radius = 0.08;
  const Mesh mesh = weld(triangles(test_support::sphere(radius)));
  const MeshSurface surface = surfaceFromMesh(mesh, place({radius, 0, 0}, {0, 1, 0}), "s");
  for (const matrix::Curvature& taxel : surface.surface.curvature)
    expectCurvature(taxel, {1 / radius, 1 / radius, 0}, kTolerance / radius);
  EXPECT_NEAR(surface.pitch_error.largest, std::cos(0.045 / radius) - 1, 0.005);
}

// For a graph x = f(u, v), with p = f_u, q = f_v: mean curvature H = ((1 + q^2) f_uu + (1 + p^2) f_vv) / (2
// w^3) and Gaussian curvature G = f_uu f_vv / w^4, w^2 = 1 + p^2 + q^2; the principal ones are H +- sqrt(H^2
// - G).
TEST(MeshSurface, ASaddleHasItsTwoPrincipalCurvatures) {
  const double a = 14, b = -8;
  const Mesh mesh = weld(triangles(test_support::saddle(a, b)));
  const MeshSurface surface = surfaceFromMesh(mesh, place({0, 0, 0}, {0, 1, 0}), "saddle");
  for (std::size_t i = 0; i < 70; ++i) {
    const Point at = surface.sheet.taxels[i].fit.frame.origin;
    const double p = a * at.y(), q = b * at.z(), w = std::sqrt(1 + p * p + q * q);
    const double mean = ((1 + q * q) * a + (1 + p * p) * b) / (2 * w * w * w);
    const double gauss = a * b / (w * w * w * w);
    const double root = std::sqrt(mean * mean - gauss);
    const double strongest = mean > 0 ? mean + root : mean - root;
    EXPECT_NEAR(surface.strongest[i], strongest, kTolerance * std::abs(strongest)) << i;
    EXPECT_NEAR(surface.weakest[i], 2 * mean - strongest, kTolerance * std::abs(strongest)) << i;
  }
}

TEST(MeshSurface, ASaddleTwistsUnderDiagonalRows) {
  const Mesh mesh = weld(triangles(test_support::saddle(10, -10), {0.075, 0.075}));
  SheetPlace diagonal = place({0, 0, 0}, {0, 1, 1});
  diagonal.layout.size = {3, 3};
  const MeshSurface surface = surfaceFromMesh(mesh, diagonal, "saddle");
  expectCurvature(surface.surface.curvature[4], {0, 0, -10}, 10 * kTolerance);
}

// The ratio of true error and stated deviation is not 1, because the fits of neighbouring taxels share
// vertices. At 3 cm the error is mostly that of the polynomial.
TEST(MeshSurface, TheDeviationStatesTheErrorOnARoughMesh) {
  for (const double radius : {0.03, 0.07}) {
    for (const double noise : {0.00002, 0.00005, 0.0001}) {
      MeshOptions rough;
      rough.noise = noise;
      const Mesh mesh = weld(triangles(test_support::cylinder(radius), rough));
      const MeshSurface surface = surfaceFromMesh(mesh, place({radius, 0, 0}, {0, 1, 0}), "c");
      double squares = 0;
      for (std::size_t i = 0; i < 70; ++i) {
        squares += std::pow(surface.strongest[i] - 1 / radius, 2) / 70;
        EXPECT_NEAR(surface.sheet.taxels[i].fit.roughness, noise, 0.25 * noise);
      }
      const double error = std::sqrt(squares), stated = spread(surface.surface.deviation).median;
      std::printf("radius %g m, roughness %g m: error %.2f 1/m, stated %.2f 1/m\n", radius, noise, error,
                  stated);
      EXPECT_GT(error, 0.5 * stated);
      EXPECT_LT(error, 1.5 * stated);
    }
  }
}

// The sentence with which a place is refused.
std::string refusal(const Mesh& mesh, const SheetPlace& where) {
  return test_support::refusal([&] { surfaceFromMesh(mesh, where, "s"); }, "accepted");
}

void expectRefused(const std::string& sentence, const std::string& part) {
  EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
}

TEST(MeshSurface, RefusesAPlaceBesideTheMesh) {
  const Mesh mesh = weld(triangles(test_support::cylinder(kRadius)));
  expectRefused(refusal(mesh, place({kRadius + 0.006, 0, 0}, {0, 1, 0})), "--at is 6 mm from the mesh");
  const MeshSurface near = surfaceFromMesh(mesh, place({kRadius + 0.004, 0, 0}, {0, 1, 0}), "c");
  EXPECT_NEAR(near.sheet.distance, 0.004, 1e-4);
}

TEST(MeshSurface, RefusesRowsAlongTheNormal) {
  const Mesh mesh = weld(triangles(test_support::cylinder(kRadius)));
  expectRefused(refusal(mesh, place({kRadius, 0, 0}, {1, 0.05, 0})), "--row-direction is within 6 degrees");
  EXPECT_EQ(refusal(mesh, place({kRadius, 0, 0}, {1, 0.2, 0})), "accepted");
}

TEST(MeshSurface, NamesTheTaxelThatIsBesideTheMesh) {
  const Mesh mesh = weld(triangles(test_support::cylinder(kRadius)));
  // The rows reach from -25 to 65 mm around the cylinder. With an edge at 65 mm -+ jitter, the next taxel is
  // off.
  expectRefused(refusal(mesh, place({kRadius * std::cos(0.5), kRadius * std::sin(0.5), 0}, {0, 1, 0})),
                "column 9 is beside the mesh or in a hole of it");
  SheetPlace large = place({kRadius, 0, 0}, {0, 1, 0});
  large.layout.size = {7, 12};
  large.layout.pitch_x = 0.012;
  expectRefused(refusal(mesh, large), "column 11 ");
  large.layout.size = {64, 64};
  expectRefused(refusal(mesh, large), "but the matrix is 756 mm long; check --units");
}

TEST(MeshSurface, NamesTheTaxelInAHole) {
  MeshOptions options;
  options.hole = 0.003;
  options.hole_u = 0.025;  // column 7
  const Mesh mesh = weld(triangles(test_support::cylinder(kRadius), options));
  expectRefused(refusal(mesh, place({kRadius, 0, 0}, {0, 1, 0})),
                "the taxel at row 3, column 7 is beside the mesh or in a hole of it");
}

TEST(MeshSurface, NamesTheTaxelWithTooFewVertices) {
  MeshOptions coarse;
  coarse.edge = 0.020;
  coarse.half_u = coarse.half_v = 0.080;
  const Mesh mesh = weld(triangles(test_support::cylinder(kRadius), coarse));
  SheetPlace where = place({kRadius, 0, 0}, {0, 1, 0});
  where.radius = 0.005;
  expectRefused(refusal(mesh, where), "vertices of the mesh within 15 mm, but a fit needs 12");
}

TEST(MeshSurface, SuggestsTheUnitsWhereTheMeshIsTooLargeSmallOrSharp) {
  const std::vector<Point> corners = triangles(test_support::cylinder(kRadius));
  const auto scaled = [&](double factor) {
    std::vector<Point> result;
    for (const Point& corner : corners) result.push_back(factor * corner);
    return weld(result);
  };
  const auto at = [&](double factor) { return place({kRadius * factor, 0, 0}, {0, 1, 0}); };
  expectRefused(refusal(scaled(1000), at(1000)), "m across, but should be less than 10 m; check --units");
  expectRefused(refusal(scaled(0.1), at(0.1)), "across, but the matrix is 90 mm long; check --units");
  SheetPlace small = at(0.1);
  small.layout.size = {2, 2};
  small.layout.pitch_x = small.layout.pitch_y = 0.002;
  expectRefused(refusal(scaled(0.1), small), "1/m at the taxel at row 0, column 0");
}

// Two walls, 2 mm apart, whose normals point in opposite directions.
TEST(MeshSurface, TheOtherWallOfAThinSocketIsNotUsed) {
  std::vector<Point> corners = triangles(test_support::cylinder(kRadius));
  std::vector<Point> inner = triangles(test_support::cylinder(kRadius - 0.002));
  for (std::size_t i = 0; i < inner.size(); i += 3) std::swap(inner[i], inner[i + 1]);
  corners.insert(corners.end(), inner.begin(), inner.end());
  const MeshSurface surface =
      surfaceFromMesh(weld(corners), place({kRadius - 0.002, 0, 0}, {0, 1, 0}), "wall");
  for (const matrix::Curvature& taxel : surface.surface.curvature)
    expectCurvature(taxel, {-1 / (kRadius - 0.002), 0, 0}, kTolerance / kRadius);
}

}  // namespace
}  // namespace fsr::mesh
