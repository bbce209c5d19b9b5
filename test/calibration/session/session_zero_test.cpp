// A tare at rest at the start of a session as part of the model: when it is chosen, what it is worth, and
// that nothing changes where it is not.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "calibration/merge.h"
#include "calibration/same_tables.h"
#include "calibration/stages/session/session_rests.h"
#include "compensation/training_statistics.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/file_complaint.h"
#include "support/holds.h"
#include "support/live_rmse.h"
#include "support/memory_rig.h"

namespace fsr::calibration {
namespace {

using test_support::MemoryRig;

using test_support::memorySession;

constexpr double kOffset = 10e3;  // [Pa]

std::vector<dataset::Recording> sessions(std::size_t number, double offset, const MemoryRig& rig = {}) {
  std::vector<dataset::Recording> all;
  for (std::size_t s = 1; s <= number; ++s) all.push_back(memorySession(s, offset, rig));
  return all;
}

Calibration zeroTrained(std::vector<dataset::Recording> recordings, ZeroChoice zero = ZeroChoice::kAuto,
                        const std::string& model = "grnn", bool history = false) {
  CalibrationProblem problem{std::move(recordings), {}};
  problem.options.date = "2026-11-22T12:00:00Z";
  problem.options.history = {history, HistoryFamily::kNone};
  problem.options.regressor.name = model;
  problem.options.regressor.forest.trees = 20;
  problem.options.zero = zero;
  return calibrate(problem);
}

double rmseOf(const Calibration& calibration, std::size_t answer) {
  double square = 0, readings = 0;
  for (const SessionScore::Session& own : calibration.scores.session.sessions) {
    square += double(own.readings) * own.rmse[answer] * own.rmse[answer];
    readings += double(own.readings);
  }
  return std::sqrt(square / readings);
}

TEST(SessionZero, TakesOutThePlantedOffsets) {
  const Calibration planted = zeroTrained(sessions(7, kOffset));
  const Calibration without = zeroTrained(sessions(7, 0));
  EXPECT_EQ(planted.session_zero.tare, SessionTare::kTrained) << planted.scores.session.choice;
  ASSERT_EQ(planted.scores.session.sessions.size(), 7u);
  EXPECT_GT(rmseOf(planted, 0), 10 * rmseOf(without, 0));
  EXPECT_LT(rmseOf(planted, 2), 2.5 * rmseOf(without, 0));
  EXPECT_LT(rmseOf(planted, 2), 0.15 * rmseOf(planted, 0));
  EXPECT_DOUBLE_EQ(planted.session_zero.rmse_without, rmseOf(planted, 0));
  EXPECT_DOUBLE_EQ(planted.session_zero.rmse, rmseOf(planted, 2));
  EXPECT_EQ(planted.scores.session.sessions[1].name, "session_2.bag, flat, mount 1");
  EXPECT_LT(planted.scores.whole.rmse_percent.mean, 2 * without.scores.whole.rmse_percent.mean);
}

// The response of the tables to each session is found from sums in which that session alone is changed, one
// session after the other. Version 1a982f8 summed all sessions anew each time; it had 917.81, 834.82 and
// 805.03 with a tare that subtracts all that the tables answer at rest, as this version did before the tare
// became the change since the training. The values are of this version.
TEST(SessionZero, KeepsTheErrorsOfTablesThatAreSummedAnew) {
  const Calibration planted = zeroTrained(sessions(7, kOffset));
  const auto& scores = planted.scores.session.sessions;
  ASSERT_EQ(scores.size(), 7u);
  EXPECT_NEAR(scores[0].rmse[2], 916.04211815989, 1e-6);
  EXPECT_NEAR(scores[3].rmse[2], 833.91123685627, 1e-6);
  EXPECT_NEAR(scores[6].rmse[2], 793.11982610243, 1e-6);
}

TEST(SessionZero, WorksWithAModelOfSingleReadings) {
  const Calibration planted = zeroTrained(sessions(7, kOffset), ZeroChoice::kAuto, "monotone");
  ASSERT_TRUE(planted.session_zero.expected()) << planted.scores.session.choice;
  EXPECT_LT(planted.session_zero.rmse, 0.6 * planted.session_zero.rmse_without);
}

// Everything that existed keeps its numbers.
TEST(SessionZero, ExpectsNoTareWhereNothingWasPlanted) {
  const Calibration automatic = zeroTrained(sessions(4, 0)),
                    none = zeroTrained(sessions(4, 0), ZeroChoice::kNone);
  EXPECT_FALSE(automatic.session_zero.expected());
  EXPECT_EQ(automatic.scores.session.choice.find(
                "Tare at the start of a session: not expected, since a gain of 2 % is ruled out: it "),
            0u)
      << automatic.scores.session.choice;
  EXPECT_TRUE(none.scores.session.choice.empty());
  expectSameTables(automatic, none);
  EXPECT_EQ(automatic.scores.whole.rmse_percent.mean, none.scores.whole.rmse_percent.mean);
}

TEST(SessionZero, ChangesNothingWhereItIsNotAskedFor) {
  const Calibration none = zeroTrained(sessions(3, kOffset), ZeroChoice::kNone);
  EXPECT_FALSE(none.session_zero.expected());
  EXPECT_TRUE(none.scores.session.sessions.empty());
  const Calibration with = zeroTrained(sessions(3, kOffset));
  EXPECT_NE(with.tables.tables[0].pressure, none.tables.tables[0].pressure);
}

std::string refusalOf(const std::vector<dataset::Recording>& recordings) {
  return test_support::refusal([&] { zeroTrained(recordings, ZeroChoice::kSession); }, "accepted");
}

// One session tells nothing of others. A tare is expected, since it does no harm where they do not differ.
TEST(SessionZero, ExpectsATareWithOneSessionThatStartsAtRest) {
  const Calibration automatic = zeroTrained(sessions(1, 0));
  EXPECT_EQ(automatic.session_zero.tare, SessionTare::kTablesAlone);
  EXPECT_TRUE(test_support::holds(
      automatic.scores.session.choice,
      {"expected", "not known", "1 session, 1 of them with a rest", "two sessions or more", "2 s at rest"}));
  EXPECT_TRUE(std::isnan(automatic.session_zero.rmse));
  EXPECT_TRUE(zeroTrained(sessions(1, 0), ZeroChoice::kSession).session_zero.expected());
}

// Another session of the rig, of which all taxels read `offset` more [Pa].
dataset::Recording shiftedSession(double offset, const MemoryRig& rig) {
  dataset::Recording recording = memorySession(6, 0, rig);
  for (std::uint16_t& count : recording.counts) count = std::uint16_t(count + std::lround(offset * 5e-3));
  return recording;
}

TEST(SessionZero, TakesAnOffsetOffAndDoesNoHarmWithoutOne) {
  MemoryRig rig;
  rig.loop = 0.08;  // so that tables answer too much at rest
  rig.creep = 0.05;
  for (const std::size_t number : {1u, 2u, 4u}) {
    Calibration tared = zeroTrained(sessions(number, 0, rig)), plain = tared;
    tared.session_zero.tare = SessionTare::kTablesAlone;
    plain.session_zero.tare = SessionTare::kNone;
    const auto error = [&](const Calibration& calibration, double offset) {
      return test_support::liveRmse(calibration, {shiftedSession(offset, rig)});
    };
    EXPECT_LT(error(tared, 0), 1.01 * error(plain, 0)) << number;
    // Half of what the offset costs at least: readings beyond the highest code of training are lost.
    const double before = error(plain, 0), cost = error(plain, 25e3) - before;
    EXPECT_LT(error(tared, 25e3) - before, 0.5 * cost) << number << ": " << before << ", " << cost;
    EXPECT_GT(cost, 0.25 * before) << number;
  }
}

dataset::Recording withoutItsRest(dataset::Recording recording) {
  for (std::size_t i = 0; i < 60; ++i) recording.pressure[i] = 300e3;
  return recording;
}

TEST(SessionZero, NeedsARestAtTheStart) {
  std::vector<dataset::Recording> recordings = sessions(2, kOffset);
  recordings[1] = withoutItsRest(recordings[1]);
  EXPECT_TRUE(restAtStart(recordings[1], 0).empty());
  EXPECT_NE(zeroTrained(recordings).scores.session.choice.find("(2 sessions, 1 of them with a rest"),
            std::string::npos);
  recordings[0] = withoutItsRest(recordings[0]);
  EXPECT_TRUE(
      test_support::holds(refusalOf(recordings), {"zero session", "session_1.bag, flat, mount 1",
                                                  "2 s at rest", "300.0 kPa, which is a load", "record"}));
  EXPECT_FALSE(zeroTrained(recordings).session_zero.expected());
}

TEST(SessionZero, TakesTheWindowOfATare) {
  const dataset::Recording recording = memorySession(1, 0);
  const std::vector<std::size_t> rest = restAtStart(recording, 0);
  ASSERT_EQ(rest.size(), 21u);
  EXPECT_DOUBLE_EQ(recording.time[rest.back()], 2.0);
}

TEST(SessionZero, GivesTheSameOnAnyNumberOfThreads) {
  CalibrationProblem problem{sessions(3, kOffset), {}};
  problem.options.history = {false, HistoryFamily::kNone};
  problem.options.threads = 1;
  const Calibration one = calibrate(problem);
  problem.options.threads = 3;
  const Calibration three = calibrate(problem);
  expectSameTables(one, three);
  EXPECT_EQ(one.scores.whole.rmse_percent.mean, three.scores.whole.rmse_percent.mean);
  EXPECT_EQ(one.session_zero.rmse, three.session_zero.rmse);
}

// The model of the sheet's memory corrects the answer after the tare.
TEST(SessionZero, LeavesTheMemoryToTheHistory) {
  MemoryRig rig;
  rig.loop = 0.08;
  const Calibration both = zeroTrained(sessions(5, kOffset, rig), ZeroChoice::kSession, "grnn", true);
  const Calibration history = zeroTrained(sessions(5, kOffset, rig), ZeroChoice::kNone, "grnn", true);
  const Calibration zero = zeroTrained(sessions(5, kOffset, rig), ZeroChoice::kSession);
  ASSERT_TRUE(both.history.present()) << both.scores.history.choice;
  const auto error = [&](const Calibration& calibration) {
    return test_support::liveRmse(calibration, {memorySession(6, kOffset, rig)});
  };
  EXPECT_LT(error(both), 0.85 * error(history));
  EXPECT_LT(error(both), 0.6 * error(zero));
}

class SessionZeroFile : public testing::Test {
 protected:
  ~SessionZeroFile() override { std::remove(path_.c_str()); }
  const std::string path_ = testing::TempDir() + "session_zero_" + std::to_string(::getpid()) + ".h5";
};

TEST_F(SessionZeroFile, KeepsTheExpectedTareAndItsScores) {
  const Calibration calibration = zeroTrained(sessions(4, kOffset));
  saveCalibration(calibration, path_);
  const Calibration loaded = loadCalibration(path_);
  EXPECT_EQ(loaded.session_zero.tare, SessionTare::kTrained);
  EXPECT_EQ(loaded.session_zero.rmse, calibration.session_zero.rmse);
  EXPECT_EQ(loaded.session_zero.at_rest, calibration.session_zero.at_rest);
  EXPECT_EQ(loaded.session_zero.at_rest.size(), calibration.tables.tables.size());
  EXPECT_EQ(loaded.session_zero.rmse_without, calibration.session_zero.rmse_without);
  EXPECT_EQ(loaded.scores.session.choice, calibration.scores.session.choice);
  ASSERT_EQ(loaded.scores.session.sessions.size(), 4u);
  EXPECT_EQ(loaded.scores.session.sessions[3].name, calibration.scores.session.sessions[3].name);
  EXPECT_EQ(loaded.scores.session.sessions[3].rmse, calibration.scores.session.sessions[3].rmse);
  EXPECT_EQ(loaded.scores.session.sessions[3].readings, calibration.scores.session.sessions[3].readings);
}

TEST_F(SessionZeroFile, ExpectsNothingWithoutIt) {
  saveCalibration(zeroTrained(sessions(2, kOffset), ZeroChoice::kNone), path_);
  EXPECT_FALSE(loadCalibration(path_).session_zero.expected());
  EXPECT_TRUE(loadCalibration(path_).scores.session.choice.empty());
}

TEST_F(SessionZeroFile, IsRefusedWithAnErrorThatCannotBe) {
  EXPECT_EQ(test_support::fileComplaint(zeroTrained(sessions(4, kOffset)), path_,
                                        [](Calibration& c) { c.session_zero.rmse = -1; }),
            "its /session/rmse has a value of -1, but all must be 0 to 1e+09");
}

TEST_F(SessionZeroFile, CannotBeMerged) {
  const Calibration calibration = zeroTrained(sessions(4, kOffset));
  try {
    mergeCalibrations({{"a.h5", calibration}, {"b.h5", calibration}}, {});
    FAIL();
  } catch (const settings::InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("a.h5: was trained with the zero of each session"), 0u)
        << error.what();
  }
}

}  // namespace
}  // namespace fsr::calibration
