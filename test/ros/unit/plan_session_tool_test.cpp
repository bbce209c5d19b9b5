#include "ros/tools/tools.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "session/plan.h"
#include "session/plan_steps.h"
#include "support/pty.h"
#include "support/source_dir.h"
#include "support/tool_run.h"

namespace {

namespace fs = std::filesystem;

class PlanSessionTool : public testing::Test {
 protected:
  std::string run(const std::vector<std::string>& words) {
    const test_support::ToolRun run = test_support::runTool(fsr_ros::planSessionTool, "plan_session", words);
    EXPECT_EQ(run.status, run.error.empty() ? 0 : -1);
    return run.said();
  }
  std::string output() const { return folder_.path("day.yaml"); }
  static bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  const std::string surfaces_ = test_support::sourceDir() + "/config/surfaces";
  const std::string field_check_ = test_support::sourceDir() + "/config/sessions/field_check.yaml";
  test_support::TemporaryFolder folder_;
};

TEST_F(PlanSessionTool, WritesAPlanThatFitsTheTimeAndSaysWhatTheWholeOneTakes) {
  const std::string printed =
      run({"--for", "discrepancy", "--minutes", "90", "--surface-folder", surfaces_, "--output", output()});
  const auto plan = fsr::session::readPlanFile(output());
  EXPECT_LE(fsr::session::sessionDuration(plan), 90 * 60);
  EXPECT_EQ(plan.name, "day");
  for (const char* part :
       {"Needed:", "They cannot tell:", "The whole plan for discrepancy takes", "written: "})
    EXPECT_TRUE(contains(printed, part)) << part << "\n" << printed;
}

TEST_F(PlanSessionTool, FindsTheSurfacesOfThePackageByItself) {
  EXPECT_TRUE(contains(run({"--for", "field_check", "--minutes", "20", "--output", output()}), "written: "));
  EXPECT_EQ(fsr::session::readPlanFile(output()).surfaces.at(0).surface.name, "flat");
}

TEST_F(PlanSessionTool, DescribesAPlanAndItsSteps) {
  EXPECT_TRUE(contains(run({field_check_}), "field_check (field_check): 19 min"));
  const std::string steps = run({field_check_, "--steps"});
  EXPECT_EQ(steps.rfind("0:00:00  mount 1 flat  (not recorded) Put the sheet on flat, mount 1.\n", 0), 0u);
  EXPECT_TRUE(contains(steps, "Cycle 5 of 5: fill to 620 kPa at 17 kPa/s"));
}

TEST_F(PlanSessionTool, RefusesWhatItCannotPlan) {
  const auto asked = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"--output", output(), "--surface-folder", surfaces_};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  EXPECT_EQ(asked({"--for", "fun", "--minutes", "90"}),
            "--for is \"fun\", but must be one of per_curvature, history, discrepancy, field_check");
  EXPECT_TRUE(contains(asked({"--for", "history"}), "--minutes"));
  EXPECT_TRUE(
      contains(asked({"--for", "history", "--minutes", "5"}), "--minutes is 5, but one cycle on flat takes"));
  EXPECT_TRUE(contains(asked({"--for", "history", "--minutes", "90", "--peak", "900"}),
                       "--peak is \"900\", but must be 1 to 793 kPa"));
  EXPECT_TRUE(
      contains(asked({"--for", "history", "--minutes", "90", "--peak", "500", "--chamber-limit", "520"}),
               "--peak is 500, but the conditioning at 110 % of it would pass the 520 kPa"));
  EXPECT_TRUE(
      contains(asked({"--for", "history", "--minutes", "90", "--surfaces", "flat,egg"}),
               "--surfaces names \"egg\", but " + surfaces_ + " has no file of this surface; it has "));
  EXPECT_TRUE(contains(asked({"--for", "history", "--minutes", "90", "--surfaces", "flat,flat"}),
                       "surfaces[1].surface is flat, which is in the list already"));
  EXPECT_FALSE(fs::exists(output()));
  EXPECT_TRUE(contains(run({field_check_, field_check_}), "give one plan"));
  EXPECT_TRUE(contains(run({field_check_, "--for", "history"}), "give either of them"));
  EXPECT_TRUE(contains(run({folder_.path("none.yaml")}), "none.yaml"));
}

TEST_F(PlanSessionTool, NeverOverwritesThePlanThatItReads) {
  const std::string mine = folder_.path("mine.yaml");
  fs::copy_file(field_check_, mine);
  EXPECT_TRUE(contains(run({mine, "--output", mine}), "mine.yaml"));
}

}  // namespace
