// A regressor that the package does not know, added to the table by the test: it trains, is saved, loaded,
// merged and answers, and is refused where it cannot do what the scheme needs.
#include <unistd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "calibration/merge.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"
#include "support/nearest_code.h"
#include "support/synthetic_recording.h"

namespace fsr::calibration {
namespace {

using test_support::regressorsWithNearestCode;
using test_support::SyntheticRig;

constexpr double kAdded = 1000;  // [Pa]

SyntheticRig rig(unsigned seed) {
  SyntheticRig rig;
  rig.name = "bag_" + std::to_string(seed);
  rig.surfaces = {{"flat", 0.0}, {"cylinder_10cm", 10.0}};
  rig.noise = 0;
  rig.seed = seed;
  return rig;
}

CalibrationProblem problem(unsigned seed = 1) {
  CalibrationProblem problem{{syntheticRecording(rig(seed))}, {}};
  problem.options.scheme = compensation::Scheme::kPerCurvature;
  problem.options.regressor.name = "nearest_code";
  problem.options.regressor.more["offset"] = kAdded;
  problem.options.regressor.table = &regressorsWithNearestCode();
  return problem;
}

std::string refusal(const CalibrationProblem& problem) {
  return test_support::refusal([&] { calibrate(problem); }, "accepted");
}

TEST(NewRegressor, TrainsAndAnswersAfterSavingAndLoading) {
  const std::string path = testing::TempDir() + "new_regressor_" + std::to_string(::getpid()) + ".h5";
  saveCalibration(calibrate(problem()), path);
  const Calibration loaded =
      loadCalibration(path, CalibrationParts::kWithoutStatistics, &regressorsWithNearestCode());
  EXPECT_EQ(loaded.regressor.name, "nearest_code");
  EXPECT_EQ(loaded.regressor.more, problem().options.regressor.more);
  EXPECT_EQ(regression::makeRegressor(loaded.regressor)->name(), "nearest_code");

  Calibrator calibrator(loaded.tables, loaded.layout);
  const SyntheticRig made = rig(1);
  const double pressure = 300e3, curvature = 10;
  calibrator.setSurface({"cylinder_10cm", 1, {{curvature, 0, 0}}, {}}, 0);
  std::vector<std::uint16_t> counts;
  for (std::size_t taxel = 0; taxel < made.size.taxels(); ++taxel) {
    counts.push_back(
        static_cast<std::uint16_t>(std::lround(syntheticReading(made, taxel, curvature, pressure))));
  }
  map::PressureMap map;
  calibrator.calibrate({made.size, made.full_scale, counts.data(), counts.size()}, 0, map);
  constexpr double kBetweenTwoScans = 12e3;  // [Pa]: a cycle of 100 scans up to 600 kPa and down
  for (const float answer : map.pressure) EXPECT_NEAR(answer, pressure + kAdded, kBetweenTwoScans);
  std::filesystem::remove(path);
}

TEST(NewRegressor, AFileOfItCanBeUsedByAPackageThatDoesNotKnowIt) {
  const std::string path = testing::TempDir() + "unknown_regressor_" + std::to_string(::getpid()) + ".h5";
  const Calibration saved = calibrate(problem());
  saveCalibration(saved, path);
  const Calibration loaded = loadCalibration(path);
  EXPECT_EQ(loaded.regressor.name, "nearest_code");
  EXPECT_EQ(loaded.tables.table(0, 0).pressure, saved.tables.table(0, 0).pressure);
  EXPECT_THROW(regression::makeRegressor(loaded.regressor), settings::InputError);
  std::filesystem::remove(path);
}

TEST(NewRegressor, IsRefusedByNameWithASchemeThatNeedsASecondInput) {
  CalibrationProblem refused = problem();
  refused.options.scheme = compensation::Scheme::kCurvatureInput;
  EXPECT_TRUE(test_support::holds(refusal(refused), {"curvature_input", "nearest_code"}));
}

TEST(NewRegressor, IsRefusedByNameWithoutItsTable) {
  CalibrationProblem refused = problem();
  refused.options.regressor.table = nullptr;
  EXPECT_TRUE(test_support::holds(refusal(refused), {"model is \"nearest_code\""}));
}

TEST(NewRegressor, CanBeMergedIfItsOptionsAgree) {
  const MergePart first{"a.h5", calibrate(problem(1))};
  MergePart second{"b.h5", calibrate(problem(2))};
  EXPECT_EQ(mergeCalibrations({first, second}).regressor.name, "nearest_code");
  second.calibration.regressor.more["offset"] = 0;
  try {
    mergeCalibrations({first, second});
    FAIL() << "merged";
  } catch (const settings::InputError& error) {
    EXPECT_TRUE(test_support::holds(error.what(), {"b.h5", "a.h5", "= 1000"}));
  }
}

}  // namespace
}  // namespace fsr::calibration
