// The curvature of a planted sheet is asked back from its readings at rest.

#include "calibration/stages/shape/read_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"
#include "support/planted_shape.h"

namespace fsr::calibration {
namespace {

using test_support::PlantedShape;

constexpr double kBadFit = 1e-3;

class ReadShape : public testing::Test {
 protected:
  RestReading mountOn(double curvature, const Eigen::VectorXd& load) {
    return mountOf(sheet_, curvature, load);
  }
  RestReading mountOn(double curvature) {
    return mountOf(sheet_, curvature, Eigen::VectorXd::Zero(Eigen::Index(taxels())));
  }
  RestReading mountOf(const PlantedShape& sheet, double curvature, const Eigen::VectorXd& load) {
    return test_support::readingOf(test_support::plantedRest(sheet, curvature) + load +
                                   test_support::drawMounts(sheet, 1, random_).row(0).transpose());
  }
  std::size_t taxels() const { return sheet_.size.taxels(); }

  std::string complaint(const RestReading& rest) const {
    return test_support::refusal([&] { reader_.estimate(rest); }, "accepted");
  }

  const PlantedShape sheet_{};
  const ShapeModel model_ = test_support::learnPlanted(sheet_);
  const ShapeReader reader_{model_};
  std::mt19937 random_{7};
};

// A mount moves the mean over the taxels by some 0.6 kPa; one 1/m moves it by 8 kPa on the flat and by
// 0.3 kPa at 20 1/m. Seeds 1 to 3 of the mounts err by 0.2 to 0.5 1/m up to 9 1/m and by 0.5 to 1.1 1/m
// beyond, where they state as much.
TEST_F(ReadShape, FindsTheCurvatureOfTrainedSurfaces) {
  constexpr int kMounts = 20;
  for (const double curvature : sheet_.curvature) {
    double squares = 0, stated = 0;
    for (int m = 0; m < kMounts; ++m) {
      const ShapeEstimate found = reader_.estimate(mountOn(curvature));
      squares += std::pow(found.curvature - curvature, 2);
      stated += found.deviation * found.deviation;
      EXPECT_EQ(found.taxels, taxels());
      EXPECT_LE(found.low, found.curvature);
      EXPECT_GE(found.high, found.curvature);
    }
    const double error = std::sqrt(squares / kMounts), deviation = std::sqrt(stated / kMounts);
    EXPECT_LT(error, 0.06 * 20) << "at " << curvature;
    EXPECT_LT(error, 1.5 * deviation) << "at " << curvature;
  }
}

// 95 %, of 200 mounts 95 +- 3 (two deviations); mounts of one sheet share the error of its model.
TEST_F(ReadShape, CoversTheCurvatureWithItsInterval) {
  int covered = 0, mounts = 0, bad = 0;
  for (const double curvature : sheet_.curvature) {
    for (int m = 0; m < 40; ++m) {
      const ShapeEstimate found = reader_.estimate(mountOn(curvature));
      const double step = (sheet_.curvature.back() - sheet_.curvature.front()) / 80;  // of the grid
      covered += found.low - step <= curvature && curvature <= found.high + step ? 1 : 0;
      bad += found.fit < 0.01 ? 1 : 0;
      ++mounts;
    }
  }
  EXPECT_GE(covered, 0.90 * mounts);
  EXPECT_LE(bad, 0.05 * mounts);
}

TEST_F(ReadShape, IsMoreCertainOfFlatThanOfATightBend) {
  EXPECT_LT(reader_.estimate(mountOn(5)).deviation, 0.7 * reader_.estimate(mountOn(14)).deviation);
}

TEST_F(ReadShape, FitsALoadOverHalfTheSheetBadly) {
  Eigen::VectorXd half = Eigen::VectorXd::Zero(Eigen::Index(taxels()));
  half.head(half.size() / 2).setConstant(40e3);
  for (const double curvature : sheet_.curvature) {
    EXPECT_LT(reader_.estimate(mountOn(curvature, half)).fit, kBadFit) << "at " << curvature;
    EXPECT_GT(reader_.estimate(mountOn(curvature)).fit, kBadFit) << "at " << curvature;
  }
}

TEST_F(ReadShape, FitsAnotherSheetBadly) {
  PlantedShape other = sheet_;
  other.fingerprint = 2;
  for (const double curvature : {9.0, 14.0, 20.0})
    EXPECT_LT(reader_.estimate(mountOf(other, curvature, Eigen::VectorXd::Zero(Eigen::Index(taxels())))).fit,
              kBadFit)
        << "at " << curvature;
  RestReading scaled = mountOn(14);
  for (std::size_t t = 0; t < taxels(); ++t) scaled.reading[t] *= t % 2 == 0 ? 0.6 : 1.4;
  EXPECT_LT(reader_.estimate(scaled).fit, kBadFit);
}

TEST_F(ReadShape, DoesWithoutSomeTaxelsButNotWithoutHalf) {
  RestReading rest = mountOn(9);
  for (std::size_t t = 0; t < 9; ++t) rest.reading[t] = NAN;
  const ShapeEstimate found = reader_.estimate(rest);
  EXPECT_EQ(found.taxels, 11u);
  EXPECT_NEAR(found.curvature, 9, 4 * found.deviation);
  rest.reading[9] = NAN;
  EXPECT_EQ(complaint(rest), "accepted") << "half of them";
  rest.reading[10] = NAN;
  EXPECT_TRUE(test_support::holds(complaint(rest), {"only 9 of 20 taxels"}));
  EXPECT_TRUE(test_support::holds(complaint({{1, 2}, {0, 0}}), {"2 taxels", "20", "the sheet has 2 taxels"}));
}

TEST_F(ReadShape, SaysThatTheSheetIsBentMoreThanInTraining) {
  const ShapeEstimate found = reader_.estimate(mountOn(30));
  EXPECT_TRUE(found.beyond || found.fit < kBadFit || found.high > 20) << found.best;
  EXPECT_FALSE(reader_.estimate(mountOn(9)).beyond);
}

TEST_F(ReadShape, RefusesAModelThatGivesNoLikelihood) {
  ShapeModel broken = model_;
  broken.scatter.deviation = std::nan("");
  EXPECT_THROW(ShapeReader(broken).estimate(mountOn(9)), settings::InputError);
}

TEST_F(ReadShape, TakesASurfaceOutOfAModelAndStillFindsIt) {
  const ShapeModel without = withoutSurface(model_, 2);
  EXPECT_EQ(without.curvature, (std::vector<double>{0, 5, 14, 20}));
  EXPECT_EQ(without.rest.size(), 4 * taxels());
  EXPECT_EQ(without.rest[2 * taxels()], model_.rest[3 * taxels()]);
  const ShapeEstimate found = ShapeReader(without).estimate(mountOn(9));
  EXPECT_NEAR(found.curvature, 9, 4 * found.deviation);
  EXPECT_TRUE(found.between);
}

// Where the error between two surfaces is known, the interval is at least as wide.
TEST_F(ReadShape, WidensBetweenTrainedSurfacesByTheErrorThatWasFoundThere) {
  ShapeModel known = model_;
  known.error_between = {2.0, 2.0, 2.0, 2.0};
  const RestReading rest = mountOn(7);
  const ShapeEstimate narrow = reader_.estimate(rest), wide = ShapeReader(known).estimate(rest);
  EXPECT_EQ(wide.curvature, narrow.curvature);
  EXPECT_LT(narrow.deviation, 1.5);
  EXPECT_GT(wide.deviation, narrow.deviation);
  EXPECT_GE(wide.high - wide.low, 2 * 1.96 * wide.deviation - 1e-9);
}

}  // namespace
}  // namespace fsr::calibration
