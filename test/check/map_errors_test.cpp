#include "check/check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/memory_rig.h"
#include "support/synthetic_recording.h"

namespace {

using fsr::check::errorsOfMap;
using fsr::check::MapErrors;
using fsr::dataset::Recording;
using test_support::memorySession;
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
MapErrors checkWith(Change change, unsigned seed = 2) {
  Recording recording = syntheticRecording(rig(seed));
  const std::size_t taxels = recording.layout.size.taxels();
  for (std::size_t i = 0; i < recording.counts.size(); ++i) {
    const double count = change(double(recording.counts[i]), i % taxels, i / taxels);
    recording.counts[i] = static_cast<std::uint16_t>(std::lround(std::min(std::max(count, 0.0), 4095.0)));
  }
  return errorsOfMap(calibration(), {recording});
}

bool says(const MapErrors& check, const std::string& part) {
  for (const std::string& reason : check.faults) {
    if (reason.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(MapErrors, AcceptsTheSameSheet) {
  for (unsigned seed = 2; seed < 12; ++seed) {
    const MapErrors check = checkWith([](double count, std::size_t, std::size_t) { return count; }, seed);
    EXPECT_TRUE(check.faults.empty()) << seed << ": " << (check.faults.empty() ? "" : check.faults.front());
    EXPECT_NEAR(check.whole.rmse() / check.whole.expectedRmse(), 1, 0.15);
    EXPECT_NEAR(check.whole.share(check.whole.within), 0.65, 0.1);
    ASSERT_EQ(check.surfaces.size(), 2u);
    EXPECT_EQ(check.surfaces[1].name, "cylinder_7cm");
  }
}

TEST(MapErrors, RejectsAWornSheet) {
  const MapErrors check = checkWith([](double count, std::size_t, std::size_t) { return 0.85 * count; });
  EXPECT_FALSE(check.faults.empty());
  EXPECT_TRUE(says(check, "below the chamber pressure on average"));
  EXPECT_TRUE(says(check, "times the expected ones"));
}

TEST(MapErrors, FindsALargerScatterByTheRmse) {
  const MapErrors check = checkWith([](double count, std::size_t taxel, std::size_t scan) {
    return count + 200 * std::sin(double(taxel * 977 + scan * 331));
  });
  EXPECT_FALSE(check.faults.empty());
  EXPECT_TRUE(says(check, "times the expected ones"));
}

TEST(MapErrors, CountsReadingsOutsideTheRangeOfTraining) {
  SyntheticRig small = rig(1);
  small.peak = 200e3;
  fsr::calibration::CalibrationProblem problem;
  problem.recordings = {syntheticRecording(small)};
  problem.options.scores = false;
  problem.options.choose_bandwidth = false;
  const MapErrors check = errorsOfMap(fsr::calibration::calibrate(problem), {syntheticRecording(rig(2))});
  EXPECT_TRUE(says(check, "of the readings are outside the range of training"));
}

TEST(MapErrors, NameAnotherSensor) {
  Recording other = syntheticRecording(rig(2));
  other.sensor.serial = "FSR-0002";
  fsr::calibration::Calibration ours = calibration();
  ours.sensor.serial = "FSR-0001";
  EXPECT_TRUE(says(errorsOfMap(ours, {other}), "is of sensor FSR-0002"));
}

// The sheet has an offset in each session, or a loop.
fsr::calibration::Calibration trained(const std::vector<Recording>& recordings, bool history = true) {
  fsr::calibration::CalibrationProblem problem{recordings, {}};
  problem.options.history = {history, fsr::calibration::HistoryFamily::kNone};
  return fsr::calibration::calibrate(problem);
}

fsr::calibration::Calibration sessions(std::size_t number, double offset) {
  std::vector<Recording> all;
  for (std::size_t s = 1; s <= number; ++s) all.push_back(memorySession(s, offset));
  return trained(all, false);
}

test_support::MemoryRig loopRig() {
  test_support::MemoryRig rig;
  rig.program = test_support::variedProgram();
  rig.loop = 0.08;
  return rig;
}

// A protocol that training has not seen.
Recording another() {
  test_support::MemoryRig rig = loopRig();
  rig.program = {{3, 500e3, 35e3, 8, 6}, {2, 600e3, 12e3, 4, 4}};
  rig.seed = 2;
  return test_support::memoryRecording(rig);
}

TEST(MapErrorsOfASession, AreThoseWithTheTareAtTheStart) {
  const fsr::calibration::Calibration calibration = sessions(7, 10e3);
  const MapErrors check = errorsOfMap(calibration, {memorySession(8, 10e3)});
  EXPECT_LT(check.whole.rmse(), 0.3 * check.rmse_without_tare);
  ASSERT_FALSE(check.remarks.empty());
  EXPECT_EQ(check.remarks[0].find("each session is checked with a tare at its start, as the calibration "
                                  "expects; without it the RMSE is "),
            0u)
      << check.remarks[0];
  Recording loaded = memorySession(8, 10e3);  // from the start
  for (std::size_t i = 0; i < 60; ++i) loaded.pressure[i] = 300e3;
  const MapErrors blind = errorsOfMap(calibration, {loaded});
  EXPECT_DOUBLE_EQ(blind.whole.rmse(), blind.rmse_without_tare);
  EXPECT_NE(blind.remarks[1].find("not tared, because it does not start with 2 s at rest"),
            std::string::npos);
  const MapErrors none = errorsOfMap(sessions(3, 0), {memorySession(8, 0)});
  EXPECT_TRUE(std::isnan(none.rmse_without_tare));
}

// Static beside history, in the live map.
TEST(MapErrorsOfMemory, StatesPartsAndWhatWasNotSettled) {
  const fsr::calibration::Calibration calibration = trained({test_support::memoryRecording(loopRig())});
  const MapErrors check = errorsOfMap(calibration, {another()});
  const auto part = [&](const std::string& name) {
    for (const fsr::calibration::HistoryScore::Part& own : check.history)
      if (own.name.rfind(name, 0) == 0) return own;
    ADD_FAILURE() << "no part " << name;
    return fsr::calibration::HistoryScore::Part{};
  };
  EXPECT_DOUBLE_EQ(part("all readings").rmse, check.whole.rmse());
  const double all = double(part("all readings").readings), open = double(part("not settled").readings);
  EXPECT_DOUBLE_EQ(double(part("loading").readings + part("unloading").readings), all - open);
  EXPECT_LT(open, 0.01 * all) << "a bag that begins at rest is settled at once";
  EXPECT_LT(part("unloading").rmse, 0.5 * part("unloading").static_rmse);
  EXPECT_LT(part("ramps of 35").rmse, 10e3);
}

// A bag that begins under load and ends before the memory of the sheet is known.
TEST(MapErrorsOfMemory, SaysWhichPromiseItCannotSee) {
  const fsr::calibration::Calibration calibration = trained({test_support::memoryRecording(loopRig())});
  EXPECT_TRUE(errorsOfMap(calibration, {another()}).not_shown.empty());
  const Recording held = test_support::partOf(another(), 60, 68);  // 120 to 136 kPa of 600
  const MapErrors check = errorsOfMap(calibration, {held});
  ASSERT_EQ(check.not_shown.size(), 2u);
  EXPECT_GT(check.whole.share(check.whole.unsettled), 0.5);
  EXPECT_NE(check.not_shown[0].find(" of the readings were not settled, so that the RMSE that training found "
                                    "with it"),
            std::string::npos)
      << check.not_shown[0];
  EXPECT_EQ(check.history[1].name, "not settled");
  EXPECT_EQ(check.not_shown[1].find("pressures of "), 0u) << check.not_shown[1];
}

// Replays of 10 s that begin on the way up, of partial cycles. The plays are at one end of what is possible.
// With the sum of the squares as deviation 37 % were covered.
TEST(MapErrorsOfMemory, CoversReplaysFromTheMiddleOfASession) {
  const fsr::calibration::Calibration calibration = trained({test_support::memoryRecording(loopRig())});
  test_support::MemoryRig rig = loopRig();
  rig.program = {{3, 300e3, 35e3, 8, 6}, {2, 360e3, 12e3, 4, 4}};
  rig.seed = 2;
  const Recording whole = test_support::memoryRecording(rig);
  double within = 0, open = 0, by_direction = 0;
  for (std::size_t first = 20; first + 100 < whole.scans(); first += 30) {
    if (whole.pressure[first] < 60e3 || whole.pressure[first] <= whole.pressure[first - 10]) continue;
    const MapErrors errors = errorsOfMap(calibration, {test_support::partOf(whole, first, first + 100)});
    for (const auto& part : errors.history) {
      if (part.name.rfind("not settled, ", 0) == 0) by_direction += double(part.readings);
      if (part.name != "not settled") continue;
      within += part.within_one_deviation * double(part.readings);
      open += double(part.readings);
    }
  }
  EXPECT_GT(open, 1000);
  EXPECT_EQ(by_direction, open);
  EXPECT_GT(within / open, 0.60);
  EXPECT_LT(within / open, 0.76);
}

// The second bag begins under load. Its memory is known only where the sheet lay on.
TEST(MapErrorsOfMemory, GoesOnInTheNextBagOfASheetThatLayOn) {
  const fsr::calibration::Calibration calibration = trained({test_support::memoryRecording(loopRig())});
  const Recording whole = another();
  const Recording first = test_support::partOf(whole, 0, 60);
  Recording second = test_support::partOf(whole, 60, whole.scans());
  const double undivided = errorsOfMap(calibration, {whole}).whole.rmse();
  EXPECT_NEAR(errorsOfMap(calibration, {second, first}).whole.rmse(), undivided, 1e-6 * undivided);
  second.conditions[0].mount = 2;
  EXPECT_GT(errorsOfMap(calibration, {second, first}).whole.rmse(), 1.01 * undivided);
}

}  // namespace
