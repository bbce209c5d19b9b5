// A planted sheet lies on cones: how much its bend changes is asked back from its readings at rest.

#include "calibration/stages/shape/learn_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/planted_shape.h"

namespace fsr::calibration {
namespace {

using test_support::PlantedShape;

constexpr double kAlarm = 0.005;

class TellBendChange : public testing::Test {
 protected:
  // From first to last column and row [1/m].
  Eigen::VectorXd cone(double centre, double along_x, double along_y) const {
    const auto rows = double(sheet_.size.rows - 1), columns = double(sheet_.size.columns - 1);
    const std::vector<matrix::Position> places = test_support::plantedPlaces(sheet_);
    const double pitch = test_support::plantedLayout(sheet_).pitch_x;
    double middle_x = 0, middle_y = 0;
    for (const matrix::Position& place : places) {
      middle_x += place.x / double(places.size());
      middle_y += place.y / double(places.size());
    }
    Eigen::VectorXd rest(static_cast<Eigen::Index>(places.size()));
    for (std::size_t t = 0; t < places.size(); ++t) {
      const double x = (places[t].x - middle_x) / pitch / columns,
                   y = (places[t].y - middle_y) / pitch / rows;
      rest(Eigen::Index(t)) =
          test_support::plantedRest(sheet_, centre + along_x * x + along_y * y)(Eigen::Index(t));
    }
    return rest;
  }

  ChangingBend tell(const Eigen::VectorXd& pressure) {
    const RestReading rest =
        test_support::readingOf(pressure + test_support::drawMounts(sheet_, 1, random_).row(0).transpose());
    return tellBendChange(reader_, model_, rest, reader_.estimate(rest));
  }

  const PlantedShape sheet_{};
  const ShapeModel model_ = test_support::learnPlanted(sheet_);
  const ShapeReader reader_{model_};
  std::mt19937 random_{11};
};

TEST_F(TellBendChange, FindsSizeSignAndAxis) {
  for (const double change : {-12.0, 12.0}) {
    for (const bool along_row : {true, false}) {
      const ChangingBend found = tell(cone(9, along_row ? change : 0.0, along_row ? 0.0 : change));
      EXPECT_LT(found.probability, kAlarm);
      EXPECT_GT(found.fit, 0.001);
      const BendChange& own = along_row ? found.along_x : found.along_y;
      const BendChange& other = along_row ? found.along_y : found.along_x;
      EXPECT_NEAR(own.change, change, 5) << (along_row ? "row" : "column");
      EXPECT_NEAR(own.change, change, 3 * own.deviation);
      EXPECT_NEAR(other.change, 0, 3 * other.deviation);
      EXPECT_NEAR(found.centre, 9, 3);
      EXPECT_NEAR(own.low, own.change - 1.96 * own.deviation, 1e-9);
      const auto [low, high] = std::minmax_element(found.curvature.begin(), found.curvature.end());
      EXPECT_NEAR(*high - *low, std::abs(found.along_x.change) + std::abs(found.along_y.change), 1);
    }
  }
}

// Of 60 mounts 0.3 are expected to seem to change.
TEST_F(TellBendChange, SeesNoneOnCylinders) {
  int seen = 0;
  for (int m = 0; m < 12; ++m) {
    for (const double curvature : sheet_.curvature)
      seen += tell(test_support::plantedRest(sheet_, curvature)).probability < kAlarm ? 1 : 0;
  }
  EXPECT_LE(seen, 3);
}

// It is the same to the sheet whether a strap presses on half of it or its bend changes.
TEST_F(TellBendChange, SeesALoadOnHalfTheSheet) {
  for (const double curvature : {5.0, 9.0, 14.0}) {
    Eigen::VectorXd rest = test_support::plantedRest(sheet_, curvature);
    rest.head(rest.size() / 2).array() += 15e3;
    EXPECT_LT(tell(rest).probability, kAlarm) << "at " << curvature;
  }
}

TEST_F(TellBendChange, BoundsNothingWithoutSeveralRows) {
  PlantedShape strip;
  strip.size = {1, 20};
  const ShapeModel model = test_support::learnPlanted(strip);
  const ShapeReader reader(model);
  const RestReading rest = test_support::readingOf(test_support::plantedRest(strip, 9));
  const ChangingBend found = tellBendChange(reader, model, rest, reader.estimate(rest));
  EXPECT_GT(found.along_y.deviation, 100);
  EXPECT_LT(found.along_x.deviation, 10);
}

}  // namespace
}  // namespace fsr::calibration
