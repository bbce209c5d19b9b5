#include "session/day_report.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "session/coverage.h"
#include "session/plan.h"
#include "session/rig_day.h"
#include "session/session_files.h"
#include "settings/sha256.h"
#include "support/folder_test.h"
#include "support/holds.h"

namespace {

using namespace fsr::session;
using rig_day::planFrom;
using rig_day::RigDay;
namespace fs = std::filesystem;

constexpr char kShortDay[] =
    "plan: \"<my> day\"\n"
    "conditioning: {cycles: 1, rate: 20000}\n"
    "rest: {before: 5, after: 5}\n"
    "order: listed\n"
    "repeat_first: false\n"
    "surfaces: [{surface: flat}, {surface: cylinder_5cm}]\n"
    "program: [{cycles: {peak: 600000, fill_rate: 20000, vent_rate: 20000, dwell_peak: 1, dwell_rest: 1, "
    "cycles: 2}}]\n";

class DayRecord : public test_support::FolderTest {
 protected:
  void touch(const std::string& name) const { std::ofstream(folder_ / name) << "x"; }
};

// Steps: 1 mount, 2 conditioning, 3 rest, 4 and 5 cycles, 6 rest; 7 mount and so on.
ConductorState dayWithTrouble(RigDay& day) {
  while (day.conductor.instruction().step < 4) day.follow();
  day.ramp(300e3, 20e3), day.ramp(0, 20e3), day.stay(5);  // too low
  EXPECT_EQ(day.rejected().size(), 1u);
  day.follow();
  EXPECT_TRUE(day.conductor.skip().done);
  return day.conductor.state();
}

TEST_F(DayRecord, FindsTheBagsOfEachMount) {
  const auto plan = planFrom(kShortDay);
  for (const char* const name :
       {"_my__day_01_flat.bag", "_my__day_01_flat_part10.bag", "_my__day_01_flat_part2.bag",
        "_my__day_01_flat_part3.bag.active", "_my__day_01_flat_copy.bag", "other_01_flat.bag"})
    touch(name);
  EXPECT_EQ(bagsOf(dayOf(plan, Conductor(plan).state(), folder_.string())),
            (std::vector<std::string>{"_my__day_01_flat.bag", "_my__day_01_flat_part2.bag",
                                      "_my__day_01_flat_part10.bag"}));
  EXPECT_EQ(freeBagName(folder_.string(), bagStem(plan.name, 1, "flat")), path("_my__day_01_flat_part4"));
}

TEST_F(DayRecord, ThePlanInTheFolderIsThePlanOfTheState) {
  const auto plan = planFrom(kShortDay);
  std::ofstream(path("plan.yaml")) << planText(plan, {"The plan of this session."});
  EXPECT_EQ(digestOf(fsr::session::readPlanFile(path("plan.yaml"))), digestOf(plan));
}

// Written before the digest was that of the content: it is the SHA-256 of the text that the writer of that
// version put into the folder, without its first line.
TEST_F(DayRecord, ASessionWhosePlanWasWordedOtherwiseGoesOn) {
  const auto plan = planFrom(kShortDay);
  std::string text = planText(plan);
  text.replace(text.find("# of the order"), 14, "# in other words");
  std::ofstream(path(sessionFile(plan.name, kPlanFile))) << "# The plan of this session.\n" << text;
  RigDay rig(plan);
  ConductorState state = dayWithTrouble(rig);
  state.digest = fsr::settings::sha256(text.data(), text.size());
  writeState(path("state.yaml"), state);
  EXPECT_EQ(Conductor(plan, readState(path("state.yaml"))).state().steps, state.steps);

  auto other = plan;
  other.rest.before += 1;
  EXPECT_THROW(Conductor(other, readState(path("state.yaml"))), fsr::settings::InputError);
  std::ofstream(path(sessionFile(plan.name, kPlanFile)), std::ios::app) << "# changed by hand\n";
  EXPECT_THROW(Conductor(plan, readState(path("state.yaml"))), fsr::settings::InputError);
}

TEST_F(DayRecord, ADigestIsThatOfWhatIsDone) {
  const auto plan = planFrom(kShortDay);
  auto same = plan;
  same.origin = "elsewhere.yaml";
  same.thermometer = !plan.thermometer;
  EXPECT_EQ(digestOf(same), digestOf(plan));
  auto bent = plan;
  bent.surfaces.back().surface.curvature.front().x += 0.1;
  EXPECT_NE(digestOf(bent), digestOf(plan));
  auto longer = plan;
  longer.rest.after += 1;
  EXPECT_NE(digestOf(longer), digestOf(plan));
}

TEST_F(DayRecord, TheStateKeepsWhyStepsWereRejectedOrAcceptedByHand) {
  const auto plan = planFrom(kShortDay);
  RigDay rig(plan);
  ConductorState state = dayWithTrouble(rig);
  state.remarks.push_back({4, Reason::kNone, "accepted by hand, although: \"so\""});
  writeState(path("state.yaml"), state);
  const ConductorState read = readState(path("state.yaml"));
  ASSERT_EQ(read.remarks.size(), 2u);
  EXPECT_EQ(read.remarks[0].step, 3u);
  EXPECT_EQ(read.remarks[0].reason, Reason::kPeakMissed);
  EXPECT_EQ(read.remarks[0].sentence, state.remarks[0].sentence);
  EXPECT_EQ(read.remarks[1].reason, Reason::kNone);
  EXPECT_EQ(read.remarks[1].sentence, "accepted by hand, although: \"so\"");
  EXPECT_EQ(Conductor(plan, read).state().remarks.size(), 2u);  // they outlive a restart
}

TEST_F(DayRecord, AStateFileWithoutRemarksIsStillRead) {
  std::ofstream(path("state.yaml")) << "plan: day\ndigest: x\ntime: 1\nrejected: 2\nsteps: aa.\n";
  EXPECT_TRUE(readState(path("state.yaml")).remarks.empty());
}

TEST_F(DayRecord, ARemarkOnAStepThatThePlanDoesNotHaveIsRefused) {
  std::ofstream(path("state.yaml"))
      << "plan: day\ndigest: x\ntime: 1\nrejected: 2\nsteps: aa.\nremarks: [{step: 4, sentence: so}]\n";
  EXPECT_THROW(readState(path("state.yaml")), fsr::settings::InputError);
}

TEST_F(DayRecord, SeveralSessionsInOneFolderNeedAPlan) {
  const auto said = [&](const std::string& plan) -> std::string {
    try {
      return stateFileIn(folder_.string(), plan);
    } catch (const fsr::settings::InputError& error) {
      return error.what();
    }
  };
  EXPECT_NE(said("").find("has no *_session.yaml"), std::string::npos) << said("");
  touch("a_session.yaml");
  EXPECT_EQ(said(""), "a_session.yaml");
  touch("b_session.yaml");
  EXPECT_TRUE(test_support::holds(said(""), {"a_session.yaml and b_session.yaml; say which with --plan"}));
  EXPECT_EQ(said("b"), "b_session.yaml");
}

TEST(CoverageSvg, GivesTheNumbersOfEachCellAndEscapesNames) {
  Coverage coverage;
  coverage.largest_peak = 500e3;
  coverage.surfaces = {
      {"<flat>", 0, std::vector<Share>(Coverage::kBins), std::vector<Share>(Coverage::kBins)}};
  coverage.surfaces[0].loading[1] = {5, 2};
  coverage.paces[20e3] = {5, 5};
  const std::string svg = coverageSvg(coverage);
  EXPECT_TRUE(test_support::holds(svg, {"<title>&lt;flat&gt;, loading, 50 to 100 kPa: 2 of 5</title>",
                                        "<title>pace 20 kPa/s: 5 of 5</title>"}));
  EXPECT_EQ(svg.find("unloading, 0 to 50 kPa:"), std::string::npos);  // not planned
  EXPECT_EQ(svg.find("<flat>"), std::string::npos);
}

}  // namespace
