#include "session/plan.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "session/example_plans.h"
#include "session/plan_steps.h"

namespace fsr::session {
namespace {

using namespace example_plans;

TEST(PlanFile, ReadsEveryField) {
  const SessionPlan plan = planFrom(
      "plan: day\npurpose: history\nseed: 7\norder: listed\nrepeat_first: false\nthermometer: true\n"
      "chamber_limit: 700000\nchange: 100\nmatrix: {rows: 1, columns: 2}\n"
      "conditioning: {cycles: 4, share_of_peak: 1.2, rate: 30000, dwell_peak: 2, dwell_rest: 3}\n"
      "rest: {before: 10, after: 20}\ntolerance: {peak: 0.1, rate: 0.5, dwell: 4}\n"
      "surfaces: [{surface: flat, mounts: 2}, {surface: bowl, taxels: {x: [1, 2], y: [3, 4]}}]\n"
      "program: [{loops: {low: 100000, high: 500000, rate: 20000, loops: 3}}]\n"
      "breaks: [{after: 2, duration: 3600}]\n");
  EXPECT_EQ(plan.name, "day");
  EXPECT_EQ(plan.purpose, Purpose::kHistory);
  EXPECT_EQ(plan.seed, 7u);
  EXPECT_FALSE(plan.drawn_order);
  EXPECT_FALSE(plan.repeat_first);
  EXPECT_TRUE(plan.thermometer);
  EXPECT_EQ(plan.chamber_limit, 700e3);
  EXPECT_EQ(plan.change, 100);
  EXPECT_EQ(plan.conditioning.cycles, 4u);
  EXPECT_EQ(plan.conditioning.rate, 30e3);
  EXPECT_NEAR(conditioningPeak(plan), 600e3, 1e-6);
  EXPECT_EQ(plan.rest.before, 10);
  EXPECT_EQ(plan.rest.after, 20);
  EXPECT_EQ(plan.tolerance.peak, 0.1);
  EXPECT_EQ(plan.tolerance.rate, 0.5);
  EXPECT_EQ(plan.tolerance.dwell, 4);
  ASSERT_EQ(plan.surfaces.size(), 2u);
  EXPECT_EQ(plan.surfaces[0].mounts, 2u);
  EXPECT_EQ(plan.surfaces[1].surface.curvature.at(1).y, 4);
  EXPECT_EQ(largestPeak(plan), 500e3);
  EXPECT_EQ(plan.breaks.at(0).duration, 3600);
  EXPECT_EQ(mountsOf(plan), 3u);
}

TEST(PlanFile, IsTheSameAfterItWasWritten) {
  std::vector<SessionPlan> plans = {shipped("paper"), shipped("every_effect"), shipped("field_check")};
  plans.push_back(
      planFrom("plan: \"odd: \\\"name\\\"\"\nmatrix: {rows: 1, columns: 2}\nchange: 61.7\n"
               "surfaces: [{surface: inside, cylinder: {radius: 0.0713, axis: x, side: inside}}, "
               "{surface: saddle, two_planes: {x: 5, y: -3, xy: 0.1}, deviation: 0.3}, {surface: bowl, "
               "taxels: {x: [1, 2], "
               "y: [3, 4], deviation: [0.1, 0.2]}}]\n"
               "program: [{cycles: {peak: 543210, fill_rate: 12345, vent_rate: 54321, cycles: 3}}, "
               "{hold: {pressure: 300000, duration: 60}}, {rest: {duration: 5}}]\n"));
  for (const SessionPlan& plan : plans) {
    const std::string text = planText(plan, {"A remark."});
    const SessionPlan read = planFrom(text);
    EXPECT_EQ(planText(read, {"A remark."}), text);
    EXPECT_EQ(sessionDuration(read), sessionDuration(plan)) << plan.name;
    ASSERT_EQ(read.surfaces.size(), plan.surfaces.size());
    for (std::size_t s = 0; s < plan.surfaces.size(); ++s) {
      EXPECT_TRUE(matrix::sameCondition(read.surfaces[s].surface, plan.surfaces[s].surface))
          << plan.surfaces[s].surface.name;
      EXPECT_EQ(read.surfaces[s].surface.deviation, plan.surfaces[s].surface.deviation);
      EXPECT_EQ(read.surfaces[s].mounts, plan.surfaces[s].mounts);
    }
  }
}

TEST(PlanFile, RadiiAreWrittenAsTheyWereGiven) {
  EXPECT_TRUE(holds(planText(shipped("paper")), {"cylinder: {radius: 0.07, axis: y}"}));
}

// docs/sessions.md states these durations.
TEST(PlanFile, ShippedPlansAreReadAndStateTheirDuration) {
  const std::pair<const char*, const char*> kPlans[] = {
      {"paper", "paper (per_curvature): 1 h 33 min, 6 mounts on 6 surfaces, one bag each"},
      {"every_effect", "every_effect (discrepancy): 4 h 37 min, 9 mounts on 4 surfaces, one bag each"},
      {"field_check", "field_check (field_check): 19 min, 2 mounts on 1 surface, one bag each"}};
  for (const auto& [name, line] : kPlans) EXPECT_EQ(headline(shipped(name)), line);
  std::size_t files = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(test_support::sourceDir() + "/config/sessions")) {
    EXPECT_EQ(readPlanFile(file.path().string()).name, file.path().stem().string());
    ++files;
  }
  EXPECT_EQ(files, std::size(kPlans));
}

TEST(PlanFile, RefusesWhatCannotBeRun) {
  const std::string small = kSmall;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = small;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::pair<std::string, std::string> kBad[] = {
      {small + "chnage: 3\n", "day.yaml: chnage is not a known setting; known here: breaks, "},
      {small + "change: -3\n", "change is -3, but must be a number, 0 to 86400 s"},
      {small + "purpose: fun\n", "purpose is fun, but must be one of per_curvature, history, discrepancy"},
      {small + "order: random\n", "order is random, but must be one of drawn, listed"},
      {small + "rest: {befor: 3}\n", "rest.befor is not a known setting; known here: after, before"},
      {small + "tolerance: {peak: 2}\n", "tolerance.peak is 2, but must be a number, 0.001 to 0.5"},
      {small + "conditioning: {cycles: 2.5}\n", "conditioning.cycles is 2.5"},
      {small + "chamber_limit: 500000\n", "program reaches 600000 Pa, but chamber_limit is 500000 Pa"},
      {small + "chamber_limit: 650000\n", "conditioning reaches 660000 Pa"},
      {small + "chamber_limit: 900000\n", "chamber_limit is 900000, but must be a number, 1000 to 793000"},
      {with("600000", "800000"), "program[0].cycles.peak is 800000, but must be a number, 1000 to 793000"},
      {with("cycles: 2", "cycles: 0"), "program never ends"},
      {with("cycles: 2", "cycles: 60000"), "the session has 120000 cycles, loops and holds"},
      {with("dwell_rest: 1,", "dwell_rest: 86000,") +
           "breaks: [{after: 1, duration: 172800}, {after: 1, duration: 1}]\n",
       "breaks[1].after is 1"},
      {with("cycles: 2", "cycles: 9000"), "the session takes 310 h, but may take at most 168 h"},
      {with("{surface: flat}", ""), "surfaces is empty"},
      {with("{surface: flat}", "{surface: flat}, {surface: flat}"), "surfaces[1].surface is flat"},
      {with("{surface: flat}", "{surface: flat, mounts: 0}"), "surfaces[0].mounts is 0"},
      {with("{surface: flat}", "{surface: cylinder_6cm}"),
       "surfaces[0].surface is cylinder_6cm, but " + folder() +
           " has no file of this surface; it has cylinder_11cm, cylinder_13cm, cylinder_5cm"},
      {with("{surface: flat}", "{surface: ../surfaces/flat}"), "has no file of this surface"},
      {with("{surface: flat}", "{surface: flat, flatt: true}"), "surfaces[0].flatt is not a known setting"},
      {with("program: [{cycles: {peak: 600000, rate: 20000, dwell_peak: 1, dwell_rest: 1, cycles: 2}}]",
            "program: [{rest: {duration: 5}}]"),
       "program applies no pressure"},
      {small + "breaks: [{after: 2, duration: 10}]\n", "breaks[0].after is 2, but must be smaller"},
      {small + "breaks: [{after: 1, duration: 10}, {after: 1, duration: 10}]\n", "breaks[1].after is 1"},
      {"surfaces: [{surface: flat}]\n", "plan is missing"},
      {"plan: small\n", "surfaces is missing"},
      {"plan: small\nsurfaces: [{surface: flat}]\n", "program is missing"}};
  for (const auto& [yaml, sentence] : kBad) {
    EXPECT_TRUE(holds(refusal([&, yaml = yaml] { planFrom(yaml); }), {sentence}));
  }
  EXPECT_EQ(refusal([&] { planFrom(small); }), "");
}

TEST(PlanFile, NamesTheFolderInWhichASurfaceIsMissingAndHowToGiveAnother) {
  const auto said = [](const std::string& origin) {
    return refusal([&] { readPlan(settings::Settings::fromText(kSmall, origin)); });
  };
  EXPECT_TRUE(holds(said("/no/such/sub/my.yaml"),
                    {"surfaces[0].surface is flat, but /no/such/surfaces", "there is no such folder",
                     "plan_session --surface-folder DIR", "session.launch surfaces:=DIR"}));
  EXPECT_TRUE(
      holds(said("sub/my.yaml"), {"but " + std::filesystem::absolute("surfaces").string() + " has no file"}));
}

TEST(PlanReport, SaysThatFewCyclesOfConditioningWillBeFound) {
  const auto report = [](const std::string& cycles) {
    return planReport(planFrom(kSmall + ("conditioning: {cycles: " + cycles + "}\n")));
  };
  EXPECT_TRUE(holds(report("2"), {"recording: 2 cycles to 660 kPa. Makers of sensors ask for four or five: "
                                  "check_bag and train will say \"fewer than four\"."}));
  EXPECT_TRUE(holds(report("1"), {"recording: 1 cycle to 660 kPa. Makers"}));
  for (const char* const cycles : {"4", "0"}) EXPECT_FALSE(holds(report(cycles), {"fewer than four"}));
}

}  // namespace
}  // namespace fsr::session
