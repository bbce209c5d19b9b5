#include "session/conductor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "session/coverage.h"
#include "session/rig_day.h"
#include "session/session_files.h"
#include "support/holds.h"
#include "support/pty.h"

namespace {

using namespace fsr::session;
using rig_day::planFrom;
using rig_day::RigDay;
using rig_day::shipped;
using Names = std::vector<std::string>;

constexpr char kDay[] =
    "plan: day\n"
    "conditioning: {cycles: 2, rate: 20000}\n"
    "rest: {before: 5, after: 5}\n"
    "order: listed\n"
    "surfaces: [{surface: flat}, {surface: cylinder_5cm}]\n"
    "program: [{cycles: {peak: 600000, fill_rate: 20000, vent_rate: 20000, dwell_peak: 1, dwell_rest: 1, "
    "cycles: 2}}]\n"
    "breaks: [{after: 1, duration: 3600}]\n";

void followTo(RigDay& day, std::size_t step) {
  while (day.conductor.instruction().step < step) day.follow();
  ASSERT_EQ(day.conductor.instruction().step, step);
}

TEST(Conductor, TellsTheNumbersOfAStep) {
  RigDay day(planFrom(kDay));
  Instruction now = day.conductor.instruction();
  EXPECT_EQ(now.kind, StepKind::kMount);
  EXPECT_TRUE(now.confirm);
  EXPECT_EQ(now.surface, "flat");
  EXPECT_FALSE(day.conductor.recording());
  followTo(day, 6);
  now = day.conductor.instruction();
  EXPECT_EQ(now.plan, "day");
  EXPECT_EQ(now.kind, StepKind::kCycle);
  EXPECT_EQ(now.number, 2u);
  EXPECT_EQ(now.of, 2u);
  EXPECT_EQ(now.peak, 600e3);
  EXPECT_EQ(now.fill_rate, 20e3);
  EXPECT_EQ(now.dwell_peak, 1);
  EXPECT_TRUE(day.conductor.recording());
  EXPECT_EQ(now.remark, "");
}

TEST(Conductor, ABreakPassesWithTheChamberOff) {
  RigDay day(planFrom(kDay));
  followTo(day, 8);
  EXPECT_EQ(day.conductor.instruction().kind, StepKind::kBreak);
  day.transducer = day.board = false;
  day.stay(3590);
  EXPECT_EQ(day.conductor.instruction().step, 8u);
  EXPECT_EQ(day.remark(), "");
  day.stay(20);
  EXPECT_EQ(day.conductor.instruction().step, 9u);
}

TEST(Conductor, GoesOnWhereASessionStopped) {
  const test_support::TemporaryFolder folder;
  const std::string path = folder.path("state.yaml");
  const auto plan = planFrom(kDay);
  RigDay before(plan);
  followTo(before, 6);
  before.stay(2), before.ramp(300e3, 20e3);  // and the power fails
  writeState(path, before.conductor.state());
  RigDay day(Conductor(plan, readState(path)), before.now + 50000);
  EXPECT_EQ(day.conductor.instruction().step, 6u);
  EXPECT_EQ(day.conductor.instruction().kind, StepKind::kMount);
  EXPECT_TRUE(day.conductor.instruction().confirm);
  EXPECT_FALSE(day.conductor.recording());
  day.stay(5);
  EXPECT_EQ(day.rejected(), Names{});
  EXPECT_TRUE(day.conductor.confirm().done);
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  EXPECT_EQ(day.conductor.instruction().step, 7u);
}

TEST(Conductor, BeginsTheMountAgainIfTheSheetWasTakenOffMeanwhile) {
  const auto plan = planFrom(kDay);
  RigDay before(plan);
  followTo(before, 11);
  RigDay day(Conductor(plan, before.conductor.state()), before.now + 50000);
  EXPECT_TRUE(day.conductor.reject("taken off").done);
  const std::vector<Outcome> outcomes = day.conductor.takeOutcomes();
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_TRUE(outcomes[0].mount_again);
  EXPECT_EQ(day.conductor.instruction().step, 9u);
  EXPECT_EQ(day.conductor.instruction().surface, "cylinder_5cm");
}

TEST(Conductor, ABreakGoesOnOverTheNight) {
  const auto plan = planFrom(kDay);
  RigDay before(plan);
  followTo(before, 8);
  RigDay day(Conductor(plan, before.conductor.state()), before.now + 50000);
  day.transducer = false;
  day.stay(1);
  EXPECT_EQ(day.conductor.instruction().step, 9u);
}

TEST(Conductor, RefusesTheStateOfAnotherPlan) {
  ConductorState state = Conductor(planFrom(kDay)).state();
  state.digest[0] = state.digest[0] == '0' ? '1' : '0';
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { Conductor(planFrom(kDay), state); }),
                                  {"plan \"day\", which differs from day.yaml"}));
}

TEST(Conductor, RefusesADamagedState) {
  const test_support::TemporaryFolder folder;
  const std::string path = folder.path("state.yaml");
  std::ofstream(path) << "plan: day\ndigest: x\ntime: 1\nrejected: 0\nsteps: aax.\n";
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { readState(path); }),
                                  {"steps is aax., but must consist of"}));
}

TEST(Conductor, SkipsAWholeMount) {
  RigDay day(planFrom(kDay));
  followTo(day, 9);
  EXPECT_TRUE(day.conductor.skip().done);
  EXPECT_EQ(std::count(day.conductor.states().begin(), day.conductor.states().end(), StepState::kSkipped), 5);
  EXPECT_EQ(day.conductor.instruction().mount, 3u);
  followTo(day, day.conductor.instruction().steps);
  day.follow();
  EXPECT_TRUE(day.conductor.done());
  EXPECT_TRUE(test_support::holds(day.conductor.instruction().text, {"13 steps accepted, 5 skipped, 0 att"}));
  EXPECT_FALSE(day.conductor.reject("").done);
  EXPECT_TRUE(day.conductor.done());
}

TEST(Conductor, TakesBackAnAcceptedStepAndAcceptsARejectedOneByHand) {
  RigDay day(planFrom(kDay));
  followTo(day, 6);
  EXPECT_FALSE(day.conductor.accept().done);
  EXPECT_TRUE(day.conductor.reject("a door was slammed").done);
  EXPECT_EQ(day.conductor.instruction().step, 5u);
  EXPECT_EQ(day.remark(), "last attempt rejected: a door was slammed");
  day.cycle(400e3, 20e3, 1, 20e3, 1);
  EXPECT_EQ(day.rejected(), (Names{"by_hand", "peak_missed"}));
  EXPECT_TRUE(day.conductor.accept().done);
  EXPECT_EQ(day.conductor.instruction().step, 6u);
  EXPECT_EQ(day.conductor.state().rejected, 2u);
}

TEST(Conductor, OffersToSkipAfterManyAttempts) {
  RigDay day(planFrom(kDay));
  followTo(day, 5);
  for (int attempt = 0; attempt < 3; ++attempt) day.cycle(400e3, 20e3, 1, 20e3, 2);
  EXPECT_TRUE(
      test_support::holds(day.conductor.instruction().text, {"3 attempts were rejected: skip this step"}));
}

TEST(Conductor, AnOperatorWhoStopsHalfWayLosesNothing) {
  RigDay day(planFrom(kDay));
  followTo(day, 6);
  day.stay(3 * 3600);  // lunch
  EXPECT_EQ(day.conductor.instruction().step, 6u);
  EXPECT_EQ(day.remark(), "");
  day.follow();
  EXPECT_EQ(day.conductor.instruction().step, 7u);
}

TEST(Conductor, SaysWhenNoReadingComesAtAll) {
  RigDay day(planFrom(kDay));
  day.transducer = day.board = false;
  day.follow();
  day.stay(5);
  EXPECT_NE(day.remark().find("no reading of the chamber pressure"), std::string::npos) << day.remark();
}

TEST(Conductor, KeepsFewOutcomes) {
  RigDay day(planFrom(kDay));
  followTo(day, 5);
  for (int attempt = 0; attempt < 250; ++attempt) {
    day.stay(1), day.ramp(100e3, 1e6), day.ramp(0, 1e6), day.stay(1);
  }
  EXPECT_EQ(day.conductor.takeOutcomes().size(), Conductor::kMostOutcomes);
}

TEST(Coverage, CountsPassesPacesAndDwellsOfAcceptedSteps) {
  const auto plan = planFrom(kDay);
  RigDay day(plan);
  const auto coverage = [&] { return coverageOf(plan, day.conductor.steps(), day.conductor.states()); };
  followTo(day, 6);
  Coverage now = coverage();
  ASSERT_EQ(now.surfaces.size(), 2u);
  EXPECT_EQ(now.surfaces[0].surface, "flat");
  EXPECT_EQ(now.surfaces[1].surface, "cylinder_5cm");
  EXPECT_NEAR(now.surfaces[1].curvature, 20, 1e-9);
  EXPECT_EQ(now.surfaces[0].loading[3].planned, 4u);  // two mounts
  EXPECT_EQ(now.surfaces[0].loading[3].accepted, 1u);
  EXPECT_EQ(now.surfaces[0].unloading[9].accepted, 1u);
  EXPECT_EQ(now.surfaces[1].loading[3].accepted, 0u);
  ASSERT_EQ(now.paces.size(), 1u);
  EXPECT_EQ(now.paces.at(20e3).planned, 6u);
  EXPECT_EQ(now.paces.at(20e3).accepted, 1u);
  EXPECT_EQ(now.dwells.at(1).accepted, 1u);
}

TEST(Coverage, APictureShowsWhatIsMissing) {
  const auto plan = planFrom(kDay);
  const auto steps = sessionSteps(plan);
  const fsr::view::Image none =
      drawCoverage(coverageOf(plan, steps, std::vector<StepState>(steps.size(), StepState::kOpen)), {"day"});
  const fsr::view::Image all = drawCoverage(
      coverageOf(plan, steps, std::vector<StepState>(steps.size(), StepState::kAccepted)), {"day"});
  EXPECT_EQ(none.width(), all.width());
  EXPECT_EQ(none.height(), all.height());
  const auto count = [](const fsr::view::Image& image, fsr::view::Colour colour) {
    int pixels = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) pixels += image.at({x, y}) == colour ? 1 : 0;
    }
    return pixels;
  };
  const auto bright = fsr::view::colourAt(fsr::view::ColourMap::kCividis, 1);
  EXPECT_EQ(count(none, bright), 0);
  EXPECT_EQ(count(all, bright), 2 * 20 * 14 * 14 + 2 * 158 * 14);  // cells, then bars, inside their frames
}

// Each rejection is an event, a line of the log and one of the report.
TEST(Conductor, ABoardThatStaysSilentIsRejectedOnce) {
  RigDay day(planFrom(kDay));
  followTo(day, 4);  // a rest that is recorded
  day.stay(1);
  day.board = false;
  day.stay(60);
  EXPECT_EQ(day.rejected(), Names{"scans_lost"});
  EXPECT_NE(day.remark().find("no scan came for"), std::string::npos) << day.remark();
  day.board = true;
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  EXPECT_EQ(day.conductor.instruction().step, 5u);
}

TEST(Conductor, ARecordingThatStaysAwayIsRejectedOnce) {
  RigDay day(planFrom(kDay));
  followTo(day, 4);
  day.stay(1);
  for (int again = 0; again < 6; ++again) day.conductor.recordingTrouble("the disk is full"), day.stay(10);
  EXPECT_EQ(day.rejected(), Names{"not_recorded"});
  EXPECT_EQ(day.conductor.instruction().step, 4u);  // the rest is not in the bag
  day.conductor.recordingTrouble("");
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
}

}  // namespace
