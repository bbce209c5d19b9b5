#include "calibration/calibration_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/synthetic_recording.h"

namespace {

using fsr::calibration::CalibrationCheck;
using fsr::dataset::Recording;
using test_support::SyntheticRig;

SyntheticRig rig(unsigned seed) {
  SyntheticRig result;
  result.surfaces = {{"flat", 0.0}, {"cylinder_7cm", 14.25}};
  result.noise = 40;
  result.seed = seed;
  return result;
}

const fsr::calibration::Calibration& calibration() {
  static const fsr::calibration::Calibration instance = [] {
    fsr::calibration::CalibrationProblem problem;
    problem.recordings = {syntheticRecording(rig(1))};
    problem.options.scores = false;
    problem.options.choose_bandwidth = false;
    return fsr::calibration::calibrate(problem);
  }();
  return instance;
}

// A new bag of the same sheet with counts changed by `change`.
template <typename Change>
CalibrationCheck checkWith(Change change, unsigned seed = 2) {
  Recording recording = syntheticRecording(rig(seed));
  const std::size_t taxels = recording.layout.size.taxels();
  for (std::size_t i = 0; i < recording.counts.size(); ++i) {
    const double count = change(double(recording.counts[i]), i % taxels, i / taxels);
    recording.counts[i] = static_cast<std::uint16_t>(std::lround(std::min(std::max(count, 0.0), 4095.0)));
  }
  return checkCalibration(calibration(), {recording});
}

bool says(const CalibrationCheck& check, const std::string& part) {
  for (const std::string& reason : check.reasons) {
    if (reason.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(CalibrationCheck, AcceptsTheSameSheet) {
  for (unsigned seed = 2; seed < 12; ++seed) {
    const CalibrationCheck check =
        checkWith([](double count, std::size_t, std::size_t) { return count; }, seed);
    EXPECT_TRUE(check.still_good) << seed << ": " << (check.reasons.empty() ? "" : check.reasons.front());
    EXPECT_NEAR(check.whole.rmse / check.whole.expected_rmse, 1, 0.15);
    EXPECT_NEAR(check.whole.within_one_deviation, 0.65, 0.1);
    ASSERT_EQ(check.classes.size(), 2u);
    EXPECT_EQ(check.classes[1].name, "cylinder_7cm");
  }
}

TEST(CalibrationCheck, RejectsAWornSheet) {
  const CalibrationCheck check =
      checkWith([](double count, std::size_t, std::size_t) { return 0.85 * count; });
  EXPECT_FALSE(check.still_good);
  EXPECT_TRUE(says(check, "below the chamber pressure on average"));
  EXPECT_TRUE(says(check, "times the expected ones"));
}

TEST(CalibrationCheck, FindsALargerScatterByTheRmse) {
  const CalibrationCheck check = checkWith([](double count, std::size_t taxel, std::size_t scan) {
    return count + 200 * std::sin(double(taxel * 977 + scan * 331));
  });
  EXPECT_FALSE(check.still_good);
  EXPECT_TRUE(says(check, "times the expected ones"));
}

TEST(CalibrationCheck, NamesADeadTaxel) {
  const CalibrationCheck check =
      checkWith([](double count, std::size_t taxel, std::size_t) { return taxel == 4 ? 0 : count; });
  EXPECT_FALSE(check.still_good);
  EXPECT_TRUE(says(check, "taxels are dead: (1, 1)")) << check.reasons.front();
}

TEST(CalibrationCheck, CountsReadingsOutsideTheRangeOfTraining) {
  SyntheticRig small = rig(1);
  small.peak = 200e3;
  fsr::calibration::CalibrationProblem problem;
  problem.recordings = {syntheticRecording(small)};
  problem.options.scores = false;
  problem.options.choose_bandwidth = false;
  const CalibrationCheck check =
      checkCalibration(fsr::calibration::calibrate(problem), {syntheticRecording(rig(2))});
  EXPECT_TRUE(says(check, "of the readings are outside the range of training"));
}

TEST(CalibrationCheck, NamesAnotherSensorAndRefusesAnotherMatrix) {
  Recording other = syntheticRecording(rig(2));
  other.sensor.serial = "FSR-0002";
  fsr::calibration::Calibration ours = calibration();
  ours.sensor.serial = "FSR-0001";
  EXPECT_TRUE(says(checkCalibration(ours, {other}), "is of sensor FSR-0002"));
  other.pressure.clear();
  EXPECT_THROW(checkCalibration(ours, {other}), fsr::settings::InputError);
  SyntheticRig larger = rig(2);
  larger.size = {3, 3};
  EXPECT_THROW(checkCalibration(ours, {syntheticRecording(larger)}), fsr::settings::InputError);
  EXPECT_THROW(checkCalibration(ours, {}), fsr::settings::InputError);
}

}  // namespace
