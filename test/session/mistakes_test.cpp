// Every mistake is noticed within the attempt in which it is made, named rightly, and nothing is lost: the
// step is asked for again and is accepted once it is done as planned.

#include <gtest/gtest.h>

#include <limits>

#include "session/rig_day.h"
#include "support/holds.h"

namespace {

using rig_day::planFrom;
using rig_day::RigDay;
using Names = std::vector<std::string>;
using test_support::holds;

constexpr double kFill = 20e3, kPeak = 600e3;

struct Mistake {
  const char* name;  // of the reason
  const char* what;
  std::function<void(RigDay&)> make;  // begins at rest
};

std::ostream& operator<<(std::ostream& out, const Mistake& mistake) {
  return out << mistake.name << ": " << mistake.what;
}

const Mistake kMistakes[] = {
    {"peak_missed", "turned at 90 % of the peak",
     [](RigDay& d) { d.cycle(0.92 * kPeak, kFill, 10, kFill, 10); }},
    {"peak_missed", "turned half-way", [](RigDay& d) { d.cycle(300e3, kFill, 10, kFill, 10); }},
    {"peak_missed", "only touched the valve", [](RigDay& d) { d.cycle(30e3, kFill, 1, kFill, 10); }},
    {"peak_overshot", "8 % above the peak", [](RigDay& d) { d.cycle(1.08 * kPeak, kFill, 10, kFill, 10); }},
    {"fill_too_fast", "filled at one and a half of the pace",
     [](RigDay& d) { d.cycle(kPeak, 1.5 * kFill, 10, kFill, 10); }},
    {"fill_too_slow", "filled at half of the pace",
     [](RigDay& d) { d.cycle(kPeak, kFill / 2, 10, kFill, 10); }},
    {"fill_too_slow", "paused half-way up",
     [](RigDay& d) {
       d.stay(10), d.ramp(300e3, kFill), d.stay(12);
       d.cycle(kPeak, kFill, 10, kFill, 0);
     }},
    {"vent_too_fast", "vented at twice the pace",
     [](RigDay& d) { d.cycle(kPeak, kFill, 10, 2 * kFill, 10); }},
    {"vent_too_slow", "vented at half of the pace",
     [](RigDay& d) { d.cycle(kPeak, kFill, 10, kFill / 2, 10); }},
    {"dwell_too_short", "vented 4 s early", [](RigDay& d) { d.cycle(kPeak, kFill, 6, kFill, 10); }},
    {"dwell_too_long", "vented 5 s late", [](RigDay& d) { d.cycle(kPeak, kFill, 15, kFill, 10); }},
    {"leak", "lost 9 % in the dwell",
     [](RigDay& d) {
       d.stay(10), d.ramp(kPeak, kFill), d.ramp(0.91 * kPeak, 5e3);
       d.cycle(0.91 * kPeak, kFill, 0, kFill, 0);
     }},
    {"leak", "lost 15 % in the dwell",
     [](RigDay& d) {
       d.stay(10), d.ramp(kPeak, kFill), d.ramp(0.85 * kPeak, 8e3);
       d.ramp(0, kFill), d.stay(1);
     }},
    {"no_unloading", "stayed at the peak for a minute",
     [](RigDay& d) { d.cycle(kPeak, kFill, 60, kFill, 10); }},
    {"no_unloading", "vented to 200 kPa, then filled again",
     [](RigDay& d) {
       d.stay(10), d.ramp(kPeak, kFill), d.stay(10), d.ramp(200e3, kFill), d.ramp(kPeak, kFill);
       d.stay(10), d.ramp(0, kFill), d.stay(1);
     }},
    {"rest_too_short", "filled again after 3 s", [](RigDay& d) { d.cycle(kPeak, kFill, 10, kFill, 3); }},
    {"pressure_lost", "transducer silent in mid-cycle",
     [](RigDay& d) {
       d.stay(10), d.ramp(400e3, kFill);
       d.transducer = false, d.ramp(kPeak, kFill), d.stay(10), d.transducer = true;
       d.ramp(0, kFill), d.stay(1);
     }},
    {"pressure_invalid", "transducer unplugged in mid-cycle, reads the end of its range",
     [](RigDay& d) {
       d.stay(10), d.ramp(400e3, kFill);
       d.offset = -600e3, d.ramp(kPeak - 103e3, kFill), d.stay(10), d.offset = 0;
       d.ramp(0, kFill), d.stay(1);
     }},
    {"pressure_not_followed", "transducer whose zero is 0 kPa unplugged in mid-cycle",
     [](RigDay& d) {
       d.counts_per_kpa = 3, d.stay(10), d.ramp(400e3, kFill);
       d.plugged = false, d.ramp(kPeak, kFill), d.stay(10), d.ramp(0, kFill);
       d.plugged = true, d.stay(1);
     }},
    {"pressure_not_followed", "likewise, and plugged in again under load",
     [](RigDay& d) {
       d.counts_per_kpa = 3, d.stay(10), d.ramp(400e3, kFill);
       d.plugged = false, d.stay(15), d.plugged = true, d.ramp(kPeak, kFill);
       d.stay(10), d.ramp(0, kFill), d.stay(1);
     }},
    {"pressure_not_followed", "unplugged while venting",
     [](RigDay& d) {
       d.counts_per_kpa = 3, d.stay(10), d.ramp(kPeak, kFill), d.stay(10), d.ramp(300e3, kFill);
       d.plugged = false, d.ramp(0, kFill), d.stay(1), d.plugged = true, d.stay(1);
     }},
    {"pressure_not_followed", "unplugged, and then reads the upper end of its range",
     [](RigDay& d) {
       d.counts_per_kpa = 3, d.stay(10), d.ramp(300e3, kFill);
       d.unplugged = 1000e3, d.plugged = false, d.stay(5), d.ramp(0, kFill), d.plugged = true, d.stay(1);
     }},
    {"scans_lost", "board silent in mid-cycle",
     [](RigDay& d) {
       d.stay(10), d.ramp(400e3, kFill), d.board = false, d.stay(4), d.board = true;
       d.ramp(0, kFill), d.stay(1);
     }},
    {"scans_lost", "one scan in eleven lost",
     [](RigDay& d) { d.lost = 1, d.cycle(kPeak, kFill, 10, kFill, 10), d.lost = 0; }},
    {"time_jumped", "the clock ran backwards in mid-cycle",
     [](RigDay& d) {
       d.stay(10), d.ramp(400e3, kFill), d.now -= 500, d.ramp(kPeak, kFill), d.stay(10);
       d.ramp(0, kFill), d.stay(1);
     }},
    {"by_hand", "a person rejects the attempt",
     [](RigDay& d) {
       d.stay(10), d.ramp(400e3, kFill), d.conductor.reject("the table was hit"), d.ramp(0, kFill), d.stay(1);
     }},
};

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreNamedAtOnceAndTheStepIsAskedForAgain) {
  RigDay day(planFrom(rig_day::kCycles));
  day.follow();
  const std::size_t step = day.conductor.instruction().step;
  GetParam().make(day);
  EXPECT_EQ(day.rejected(), Names{GetParam().name}) << day.last.sentence;
  EXPECT_EQ(day.conductor.instruction().step, step);
  EXPECT_NE(day.remark(), "");
  day.cycle(kPeak, kFill, 10, kFill, 10);
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  EXPECT_EQ(day.conductor.instruction().step, step + 1);
  EXPECT_EQ(day.remark(), "");
}

INSTANTIATE_TEST_SUITE_P(All, Mistakes, testing::ValuesIn(kMistakes));

// The largest differences that a plan with tolerances of 5 %, 25 % and 2 s lets pass.
TEST(Conductor, AcceptsWhatIsWithinTheTolerance) {
  RigDay day(planFrom(rig_day::kCycles));
  day.follow();
  day.cycle(1.04 * kPeak, 1.2 * kFill, 11.5, 0.8 * kFill, 8.5);
  day.cycle(0.96 * kPeak, 0.8 * kFill, 8.5, 1.2 * kFill, 60);
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  EXPECT_TRUE(day.conductor.done());
}

TEST(Conductor, MeasuresWhatWasDone) {
  RigDay day(planFrom(rig_day::kCycles));
  day.follow();
  day.cycle(590e3, 18e3, 9, 22e3, 12);
  EXPECT_EQ(day.rejected(), Names{});
  EXPECT_NEAR(day.last.measured.peak, 590e3, 400);
  EXPECT_NEAR(day.last.measured.fill_rate, 18e3, 100);
  EXPECT_NEAR(day.last.measured.vent_rate, 22e3, 100);
  EXPECT_NEAR(day.last.measured.dwell, 9, 0.5);
  EXPECT_NEAR(day.last.measured.rest, 12, 0.7);
}

TEST(Conductor, OneSpikeSpoilsNothing) {
  RigDay day(planFrom(rig_day::kCycles));
  day.follow();
  day.stay(10), day.ramp(300e3, kFill);
  day.conductor.pressure(day.now + 0.05, 900e3);
  day.ramp(kPeak, kFill), day.stay(10);
  day.conductor.pressure(day.now + 0.05, 0);
  day.ramp(0, kFill), day.stay(1);
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  EXPECT_EQ(day.conductor.instruction().number, 2u);
}

constexpr char kOthers[] =
    "plan: others\n"
    "repeat_first: false\n"
    "conditioning: {cycles: 1, rate: 20000}\n"
    "rest: {before: 20, after: 0}\n"
    "surfaces: [{surface: flat}]\n"
    "program:\n"
    "  - loops: {low: 200000, high: 400000, rate: 20000, loops: 2}\n"
    "  - hold: {pressure: 300000, rate: 20000, duration: 60}\n";

void followUntil(RigDay& day, fsr::session::StepKind kind) {
  while (day.conductor.step() != nullptr && day.conductor.step()->kind != kind) day.follow();
  ASSERT_EQ(day.rejected(), Names{});
}

TEST(Conductor, ALoadDuringARestIsRejected) {
  RigDay day(planFrom(kOthers));
  followUntil(day, fsr::session::StepKind::kRest);
  day.stay(8), day.ramp(50e3, kFill), day.ramp(0, kFill);
  EXPECT_EQ(day.rejected(), Names{"rest_disturbed"});
  day.stay(20.5);
  EXPECT_EQ(day.conductor.step()->kind, fsr::session::StepKind::kLoop);
}

TEST(Conductor, ARestMayEndEarlyWithinTheToleranceOfDwells) {
  RigDay day(planFrom(kOthers));
  followUntil(day, fsr::session::StepKind::kRest);
  day.stay(18.8);
  day.ramp(200e3, kFill), day.ramp(400e3, kFill), day.ramp(200e3, kFill), day.stay(0.5);
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  EXPECT_EQ(day.conductor.instruction().number, 2u);
}

TEST(Conductor, SaysWhenRestIsNotReached) {
  RigDay day(planFrom(kOthers));
  followUntil(day, fsr::session::StepKind::kCondition);
  day.stay(1), day.ramp(440e3, kFill), day.stay(1), day.ramp(25e3, kFill), day.stay(120);
  EXPECT_NE(day.remark().find("does not go down to rest"), std::string::npos) << day.remark();
  day.ramp(0, kFill), day.stay(1);
  EXPECT_EQ(day.remark(), "");
}

TEST(Conductor, ALoopThatBeginsTooLowIsRejected) {
  RigDay day(planFrom(kOthers));
  followUntil(day, fsr::session::StepKind::kLoop);
  day.follow();
  day.ramp(120e3, kFill), day.ramp(400e3, kFill), day.ramp(200e3, kFill), day.stay(1);
  EXPECT_EQ(day.rejected(), Names{"base_missed"});
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  EXPECT_EQ(day.conductor.step()->kind, fsr::session::StepKind::kHold);
}

TEST(Conductor, ALoopThatTurnsTooEarlyIsRejected) {
  RigDay day(planFrom(kOthers));
  followUntil(day, fsr::session::StepKind::kLoop);
  day.ramp(400e3, kFill), day.ramp(300e3, kFill), day.ramp(400e3, kFill), day.ramp(200e3, kFill);
  day.stay(1);
  EXPECT_EQ(day.rejected(), Names{"no_unloading"});
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
}

TEST(Conductor, AHoldThatIsLetGoLeaksOrOvershootsIsRejected) {
  RigDay day(planFrom(kOthers));
  followUntil(day, fsr::session::StepKind::kHold);
  day.ramp(0, kFill), day.stay(2);
  const std::pair<const char*, std::function<void()>> ways[] = {
      {"dwell_too_short", [&] { day.ramp(300e3, kFill), day.stay(30), day.ramp(0, kFill); }},
      {"leak", [&] { day.ramp(300e3, kFill), day.ramp(260e3, 1e3), day.ramp(0, kFill); }},
      {"peak_overshot",
       [&] { day.ramp(340e3, kFill), day.ramp(300e3, kFill), day.stay(60), day.ramp(0, kFill); }},
      {"peak_missed", [&] { day.ramp(250e3, kFill), day.ramp(0, kFill); }},
      {"fill_too_slow", [&] { day.ramp(300e3, kFill / 2), day.stay(60), day.ramp(0, kFill); }},
  };
  for (const auto& [name, way] : ways) {
    way();
    day.stay(2);
    EXPECT_EQ(day.rejected(), Names{name}) << day.last.sentence;
  }
  day.ramp(300e3, kFill), day.stay(61), day.ramp(0, kFill), day.stay(1);
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  EXPECT_TRUE(day.conductor.done());
}

TEST(Conductor, ATaxelThatFallsOutIsNamedOnce) {
  RigDay day(planFrom(rig_day::kCycles));
  day.dead = 2;  // before anything was loaded: known
  day.follow();
  day.follow();
  EXPECT_EQ(day.rejected(), Names{});
  day.dead = 3;
  day.follow();
  EXPECT_EQ(day.rejected(), Names{"taxel_fell_out"});
  day.follow();
  EXPECT_EQ(day.rejected(), Names{});
  EXPECT_TRUE(day.conductor.done());
}

TEST(Conductor, AChamberThatNeverReachesThePeakIsSaidAndTheStepCanBeSkipped) {
  RigDay day(planFrom(rig_day::kCycles));
  day.follow();
  day.stay(10), day.ramp(500e3, kFill), day.stay(20);
  EXPECT_TRUE(holds(day.remark(), {"stays at 500 kPa and does not rise to 600 kPa"}));
  EXPECT_TRUE(day.conductor.skip().done);
  EXPECT_EQ(day.conductor.instruction().text.find("Vent to rest, then: Cycle 2 of 2"), 0u)
      << day.conductor.instruction().text;
  day.ramp(0, kFill), day.stay(1);
  EXPECT_EQ(day.remark(), "");
  day.follow();
  EXPECT_TRUE(day.conductor.done());
}

TEST(Conductor, SaysAtOnceWhatDoesNotFit) {
  RigDay day(planFrom(rig_day::kCycles));
  day.conductor.disk(1e6, 2000);
  day.follow();
  EXPECT_EQ(day.remark(), "");
  day.conductor.disk(1e5, 2000);  // two cycles of 80 s need 320 kB
  EXPECT_TRUE(holds(day.remark(), {"need 0.3 MB, but 0.1 MB are left on the disk"}));
  day.conductor.disk(1e6, 2000);
  day.conductor.deadline(day.now + 100);
  day.stay(1);
  EXPECT_NE(day.remark().find("needs 3 min more, but 2 min are left"), std::string::npos) << day.remark();
  day.conductor.deadline(day.now + 1000);
  day.saturated = 40;
  day.stay(1);
  EXPECT_NE(day.remark().find("40 of 70 taxels are at full scale"), std::string::npos) << day.remark();
  day.saturated = 0;
  day.ramp(800e3, kFill), day.stay(1);
  EXPECT_TRUE(holds(day.remark(), {"vent: 800 kPa is above the limit of the chamber, 793 kPa"}));
}

TEST(Conductor, SaysThatNobodyHasConfirmedTheMount) {
  RigDay day(planFrom(rig_day::kCycles));
  day.stay(1), day.ramp(100e3, kFill);
  EXPECT_TRUE(holds(day.remark(), {"the pressure rises, but nobody has confirmed"}));
  day.ramp(0, kFill), day.stay(60);
  EXPECT_TRUE(holds(day.remark(), {"the pressure rose before anybody had confirmed"}));
  EXPECT_TRUE(day.conductor.instruction().confirm);
  EXPECT_TRUE(day.conductor.confirm().done);
  EXPECT_EQ(day.remark(), "");
  EXPECT_EQ(day.rejected(), Names{});
}

TEST(Conductor, ACycleThatIsNotRecordedIsRejected) {
  RigDay day(planFrom(rig_day::kCycles));
  day.follow();
  day.conductor.recordingTrouble("the disk is full");
  day.follow();
  EXPECT_EQ(day.rejected(), Names{"not_recorded"}) << day.last.sentence;
  EXPECT_NE(day.remark().find("the disk is full"), std::string::npos);
  day.conductor.recordingTrouble("");
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
}

TEST(Conductor, ACycleOnAnotherSurfaceIsRejected) {
  RigDay day(planFrom(rig_day::kCycles));
  day.follow();
  day.conductor.surface("cylinder_5cm");
  day.follow();
  EXPECT_EQ(day.rejected(), Names{"other_surface"}) << day.last.sentence;
  day.conductor.surface("flat");
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
}

constexpr char kTwoSurfaces[] =
    "plan: rounds\n"
    "order: listed\n"
    "repeat_first: false\n"
    "conditioning: {cycles: 0}\n"
    "rest: {before: 5, after: 0}\n"
    "surfaces: [{surface: flat, mounts: 3}, {surface: cylinder_5cm, mounts: 3}]\n"
    "program: [{cycles: {peak: 600000, rate: 20000, dwell_peak: 1, dwell_rest: 1, cycles: 2}}]\n";

// Follows to the last mount, and then as if the sheet lay on the flat surface.
void followToTheWrongSurface(RigDay& day) {
  while (!day.conductor.done() && day.conductor.step()->mount < 6) {
    day.counts_per_kpa = day.conductor.step()->surface == "flat" ? 3 : 4;
    day.follow();
    EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  }
  day.counts_per_kpa = 3;
  while (!day.conductor.done() && day.conductor.step()->kind != fsr::session::StepKind::kCycle) day.follow();
  day.follow();
}

TEST(Conductor, ASurfaceThatReadsLikeAnotherOneIsAskedForAgain) {
  RigDay day(planFrom(kTwoSurfaces));
  followToTheWrongSurface(day);
  EXPECT_EQ(day.rejected(), Names{"other_surface"}) << day.last.sentence;
  EXPECT_TRUE(day.conductor.instruction().confirm);
  EXPECT_TRUE(
      holds(day.remark(), {"mount 6 reads like flat (mount 1), not like cylinder_5cm (mount 2, mount 4)"}));
  day.counts_per_kpa = 4;
  while (!day.conductor.done()) day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
}

TEST(Conductor, ASurfaceThatIsConfirmedTwiceIsAcceptedAsItIs) {
  RigDay day(planFrom(kTwoSurfaces));
  followToTheWrongSurface(day);
  EXPECT_EQ(day.rejected(), Names{"other_surface"});
  EXPECT_TRUE(day.conductor.accept().done);  // as confirming
  day.follow();
  day.follow();
  EXPECT_EQ(day.rejected(), Names{});
  EXPECT_EQ(day.last.sentence.find("accepted, because cylinder_5cm was confirmed twice, although mount 6"),
            0u)
      << day.last.sentence;
  EXPECT_NE(day.remark().find("confirmed twice"), std::string::npos) << day.remark();
  day.follow();
  EXPECT_TRUE(day.conductor.done());
}

TEST(Conductor, ASheetThatComesOffIsNamedInThisCycleOrTheNextOne) {
  RigDay day(planFrom(rig_day::kCycles));
  day.counts_per_kpa = 3;
  day.follow();
  day.stay(10), day.ramp(300e3, kFill);
  day.counts_per_kpa = 1e-9;
  day.ramp(kPeak, kFill), day.stay(10), day.ramp(0, kFill), day.stay(1);
  EXPECT_EQ(day.rejected(), Names{"sheet_off"}) << day.last.sentence;
  day.counts_per_kpa = 3;
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  day.counts_per_kpa = 1e-9;
  day.follow();
  EXPECT_EQ(day.rejected(), Names{"sheet_off"}) << day.last.sentence;
}

// A person who obeys would lose the mount: after an hour of a transducer that reads 0, the sheet's rest must
// be what it was.
TEST(Conductor, AfterATransducerThatReadNothingUnderLoadGoodAttemptsAreAccepted) {
  RigDay day(planFrom(rig_day::kCycles));
  day.counts_per_kpa = 3;
  day.follow();
  day.follow();
  day.stay(10), day.ramp(400e3, kFill);
  day.plugged = false, day.stay(120);
  EXPECT_EQ(day.rejected(), Names{"pressure_not_followed"});
  EXPECT_NE(day.remark().find("the pressure jumped from 400 kPa to "), std::string::npos) << day.remark();
  day.ramp(0, kFill), day.stay(5);
  for (int again = 0; again < 3; ++again) day.cycle(kPeak, kFill, 60, kFill, 10);  // and nobody looks
  day.plugged = true;
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
  EXPECT_TRUE(day.conductor.done());
}

// What only a sheet can tell: a chamber that is vented at once is no transducer without a plug.
TEST(Conductor, AVentWithinOneReadingThatTheSheetFollowsIsAVent) {
  RigDay day(planFrom(rig_day::kCycles));
  day.counts_per_kpa = 3;
  day.follow();
  day.stay(10), day.ramp(kPeak, kFill), day.stay(10), day.ramp(0, 1e7), day.stay(2);
  EXPECT_EQ(day.rejected(), Names{"vent_too_fast"}) << day.last.sentence;
  day.stay(10), day.ramp(300e3, kFill), day.ramp(0, 1e7), day.stay(2);
  EXPECT_EQ(day.rejected(), Names{"peak_missed"}) << day.last.sentence;
  day.follow();
  EXPECT_EQ(day.rejected(), Names{}) << day.last.sentence;
}

// What is taken for a jump at first must not become the sheet's rest.
TEST(Conductor, AFastBeginOfTheFirstLoadIsNotLearntAsRest) {
  RigDay day(planFrom(rig_day::kCycles));
  day.counts_per_kpa = 3;
  day.follow();
  day.stay(3);
  const double noise = day.conductor.noiseAtRest();
  day.ramp(60e3, 250e3), day.stay(2);  // in three readings
  EXPECT_DOUBLE_EQ(day.conductor.noiseAtRest(), noise);
}

}  // namespace
