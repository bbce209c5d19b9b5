#include "view/sheet_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "fsr_pressure_map/map/map_statistics.h"
#include "view/small_sheet.h"

namespace fsr::view {
namespace {

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(SheetMesh, CoversTheSheetToItsEdges) {
  const SheetMesh mesh(kLayout, uniform({}), 2);
  EXPECT_EQ(mesh.corners().size(), 70u * 24u);
  EXPECT_NEAR(mesh.corners().front().x, -0.050, 1e-14);
  EXPECT_NEAR(mesh.corners().front().y, -0.042, 1e-14);
  for (const double area : mesh.areas()) EXPECT_NEAR(area, 1.2e-4, 1e-14);
}

TEST(SheetMesh, TrianglesFaceTheLoadedSide) {
  const SheetMesh mesh(kLayout, uniform({20, 0, 0}), 3);
  for (std::size_t i = 0; i < mesh.corners().size(); i += 3) {
    const Vector3 &a = mesh.corners()[i], &b = mesh.corners()[i + 1], &c = mesh.corners()[i + 2];
    EXPECT_GT((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), 0);  // z of the normal
  }
}

TEST(SheetMesh, PutsTaxelCentresWhereBendSheetPutsThem) {
  matrix::Surface uneven;
  for (std::size_t i = 0; i < 70; ++i) uneven.curvature.push_back({3.0 + double(i % 10), -4, 2});
  for (const matrix::Surface& surface : {uniform({}), uniform({20, 0, 0}), uniform({7, -9, 4}), uneven}) {
    const SheetMesh mesh(kLayout, surface, 2);
    const auto poses = bendSheet(kLayout, surface);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Vector3 p = mesh.point(kLayout.row({i}), kLayout.column({i}));
      EXPECT_NEAR(p.x, poses[i].position.x, 3e-5);  // [m]; the mesh interpolates curvature in finer steps
      EXPECT_NEAR(p.y, poses[i].position.y, 3e-5);
      EXPECT_NEAR(p.z, poses[i].position.z, 3e-5);
    }
  }
}

TEST(SheetMesh, LiftsAPointAlongTheNormal) {
  const SheetMesh mesh(kLayout, uniform({}), 2);
  EXPECT_NEAR(mesh.point(3, 4.5, 0.001).z, 0.001, 1e-15);
}

TEST(TaxelAreas, OfACylinderEqualThoseOfTheFlatSheet) {
  for (const matrix::Curvature k :
       {matrix::Curvature{20, 0, 0}, matrix::Curvature{0, -20, 0}, matrix::Curvature{10, 10, 10}}) {
    for (const double area : taxelAreas(kLayout, uniform(k))) EXPECT_NEAR(area, 1.2e-4, 1e-4 * 1.2e-4);
  }
}

// On a sphere, rows are great circles at right angles to the middle column: ds^2 = dx^2 + cos^2(x / R) dy^2.
// The area of the sheet is therefore H 2 R sin(W / 2 R).
TEST(TaxelAreas, OfASphereDecreaseTowardsTheEndsOfTheRows) {
  const double radius = 0.08, width = 0.10, height = 0.084;
  const auto areas = taxelAreas(kLayout, uniform({1 / radius, 1 / radius, 0}));
  const double expected = height * 2 * radius * std::sin(width / (2 * radius));
  EXPECT_NEAR(total(areas), expected, 2e-4 * expected);
  EXPECT_LT(areas[30], areas[34]);
}

// A uniform 200 kPa on a sphere of 8 cm radius: by the equation above the area is
// 0.084 m x 0.16 m x sin(0.625) = 78.64 cm^2, so the force is 1572.8 N. The flat sheet of 84 cm^2 would give
// 1680 N.
TEST(TaxelAreas, GiveTheForceOnTheBentSheet) {
  map::PressureMap map;
  map.reset(kLayout);
  map.pressure.assign(70, 200e3f);
  const map::RegionStatistics bent =
      map::regionStatistics(map, {}, taxelAreas(kLayout, uniform({12.5, 12.5, 0})), 10e3);
  EXPECT_NEAR(bent.force, 1572.8, 0.5);
  EXPECT_NEAR(bent.contact_area, 78.64e-4, 0.02e-4);
  EXPECT_NEAR(bent.mean, 200e3, 1e-3);
  EXPECT_NEAR(map::regionStatistics(map, {}, taxelAreas(kLayout, uniform({})), 10e3).force, 1680.0, 1e-6);
}

map::PressureMap ramp() {
  map::PressureMap map;
  map.reset(kLayout);
  for (std::size_t i = 0; i < 70; ++i) map.pressure[i] = 8e3f * float(i);
  return map;
}

TEST(SheetMesh, ColoursAllCornersOfATaxelAlike) {
  const SheetMesh mesh(kLayout, uniform({}), 2);
  map::PressureMap map = ramp();
  map.pressure[69] = NAN;
  std::vector<Colour> colours;
  mesh.colourCells(map.pressure, {}, colours);
  ASSERT_EQ(colours.size(), mesh.corners().size());
  for (std::size_t i = 0; i < 69 * 24; ++i)
    EXPECT_EQ(colours[i], PressureScale{}.colour(8e3 * double(i / 24)));
  EXPECT_EQ(colours.back(), kNoReadingColour);
}

TEST(SheetMesh, InterpolatesColoursBetweenTaxelCentres) {
  const SheetMesh mesh(kLayout, uniform({}), 2);
  std::vector<Colour> colours;
  mesh.colourSmoothly(ramp().pressure, {}, colours);
  ASSERT_EQ(colours.size(), mesh.corners().size());
  EXPECT_EQ(colours[24 * 34 + 2], PressureScale{}.colour(8e3 * 34));  // third corner of taxel 34 = its centre
  EXPECT_EQ(colours[24 * 34 + 0],
            PressureScale{}.colour(8e3 * (34 + 33 + 24 + 23) / 4));  // first corner of taxel 34
}

TEST(SmoothLayer, LeavesTaxelsWithoutAReadingOut) {
  std::vector<float> values = {10, NAN, 30, 40};
  const SmoothLayer layer(values, {2, 2});
  EXPECT_DOUBLE_EQ(layer.at(0, 0), 10);
  EXPECT_TRUE(std::isnan(layer.at(0, 1)));
  EXPECT_DOUBLE_EQ(layer.at(0, 0.4), 10);
  EXPECT_DOUBLE_EQ(layer.at(1, 0.5), 35);
  EXPECT_DOUBLE_EQ(layer.at(-3, -3), 10);
}

TEST(SmoothLayer, GivesTheSameForAWholeRowAsForSinglePoints) {
  std::vector<float> values = ramp().pressure;
  values[13] = NAN;
  const SmoothLayer layer(values, kLayout.size);
  std::vector<SmoothLayer::Place> columns;
  for (double c = -0.6; c < 9.7; c += 0.13) columns.push_back(layer.column(c));
  std::vector<double> along;
  for (double r = -0.6; r < 6.7; r += 0.17) {
    layer.alongRow(layer.row(r), columns, along);
    ASSERT_EQ(along.size(), columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double point = layer.at(layer.row(r), columns[i]);
      EXPECT_EQ(std::isnan(along[i]), std::isnan(point));
      if (!std::isnan(point)) {
        EXPECT_NEAR(along[i], point, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace fsr::view
