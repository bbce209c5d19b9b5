#include "fsr_pressure_map/dataset/condition_classes.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"
#include "support/synthetic_recording.h"

namespace fsr::dataset {
namespace {

using test_support::syntheticRecording;
using test_support::SyntheticRig;
using test_support::SyntheticSurface;

Recording bag(const std::string& name, const std::vector<SyntheticSurface>& surfaces,
              std::size_t cycles = 5) {
  SyntheticRig rig;
  rig.name = name;
  rig.surfaces = surfaces;
  rig.cycles = cycles;
  return syntheticRecording(rig);
}

TEST(ConditionClasses, PoolConditionsOfTheSameCurvatureFromSeveralBags) {
  const std::vector<Recording> recordings = {bag("a", {{"cylinder_7cm", 14.3}, {"flat", 0.0}}),
                                             bag("b", {{"cylinder_5cm", 20.0}}),
                                             bag("c", {{"seven", 14.286}, {"also_flat", 0.1}}, 6)};
  const ConditionClasses pooled = poolConditions(recordings);
  ASSERT_EQ(pooled.classes.size(), 3u);
  EXPECT_EQ(pooled.classes[0].surface, "also_flat");  // six cycles, most scans
  EXPECT_EQ(pooled.classes[1].surface, "seven");
  EXPECT_EQ(pooled.classes[1].at(3), 14.286);
  EXPECT_EQ(pooled.classes[2].surface, "cylinder_5cm");
  EXPECT_EQ(pooled.class_of, (std::vector<std::vector<std::size_t>>{{1, 0}, {2}, {1, 0}}));
}

TEST(ConditionClasses, DoNotDependOnTheOrderOfTheBags) {
  const Recording a = bag("a", {{"cylinder_7cm", 14.3}, {"flat", 0.0}});
  const Recording b = bag("b", {{"seven", 14.4}, {"seven_and", 14.5}});
  const ConditionClasses forward = poolConditions({a, b});
  const ConditionClasses backward = poolConditions({b, a});
  ASSERT_EQ(forward.classes.size(), backward.classes.size());
  for (std::size_t i = 0; i < forward.classes.size(); ++i) {
    EXPECT_EQ(forward.classes[i].surface, backward.classes[i].surface);
    EXPECT_EQ(forward.classes[i].curvature, backward.classes[i].curvature);
  }
}

TEST(ConditionClasses, SeparateTheInsideOfASocketFromTheOutsideOfALimb) {
  EXPECT_EQ(poolConditions({bag("a", {{"out", 14.3}, {"in", -14.3}})}).classes.size(), 2u);
}

TEST(ConditionClasses, AreFlatOnlyWhereEveryTaxelIs) {
  EXPECT_TRUE(isFlat({"table", {0.1}}));
  EXPECT_FALSE(isFlat({"edge", {0.0, 0.0, 3.0}}));
}

TEST(ConditionClasses, RefuseAnUnknownCurvature) {
  Recording recording = bag("a.bag", {{"flat", 0.0}});
  recording.conditions.front().curvature.clear();
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { poolConditions({recording}); }),
                                  {"a.bag", "no curvature is recorded"}));
}

TEST(Coverage, CountsScansAndCyclesByBinAndDirection) {
  const Coverage coverage =
      coverageOf({bag("a", {{"flat", 0.0}}), bag("b", {{"flat", 0.0}, {"bent", 10.0}})}, 5);
  ASSERT_EQ(coverage.conditions.size(), 2u);
  const ConditionCoverage& flat = coverage.conditions[0];
  EXPECT_EQ(flat.scans, 1000u);
  EXPECT_EQ(flat.cycles, 10u);
  EXPECT_EQ(flat.pressure_low, 0.0);
  EXPECT_EQ(flat.pressure_high, 600e3);
  // 12 kPa a scan: loading passes 204 to 396 kPa in 17 scans of each cycle, unloading likewise
  EXPECT_EQ(flat.loading[3].scans, 170u);
  EXPECT_EQ(flat.unloading[3].scans, 170u);
  EXPECT_EQ(flat.loading[3].cycles, 10u);
  EXPECT_EQ(coverage.conditions[1].cycles, 5u);
}

TEST(Coverage, CountsTheMountsOfEachSurface) {
  std::vector<Recording> bags = {bag("a", {{"flat", 0.0}}), bag("b", {{"flat", 0.0}, {"bent", 10.0}})};
  bags[1].conditions[0].mount = bags[0].conditions[0].mount + 1;
  const Coverage coverage = coverageOf(bags, 5);
  EXPECT_EQ(coverage.conditions[0].mounts.size(), 2u);
  EXPECT_EQ(coverage.conditions[1].mounts.size(), 1u);
}

TEST(Coverage, ListsThinCellsWorstFirst) {
  SyntheticRig low;
  low.name = "b";
  low.surfaces = {{"bent", 10.0}};
  low.peak = 150e3;
  low.cycles = 20;
  const Coverage coverage = coverageOf({bag("a", {{"flat", 0.0}}, 20), syntheticRecording(low)}, 5);
  ASSERT_EQ(coverage.thin.size(), 5u);
  EXPECT_EQ(coverage.thin[1], "bent, 200-400 kPa loading: no scan");
  EXPECT_EQ(coverage.thin[2], "bent, 400+ kPa loading: no scan");
}

TEST(Coverage, SaysThatThereIsOneSurfaceOnlyOrThatPeaksDiffer) {
  EXPECT_TRUE(
      test_support::holds(coverageOf({bag("a", {{"flat", 0.0}}, 20)}, 5).thin.at(0), {"one surface only"}));
  SyntheticRig low;
  low.name = "b";
  low.surfaces = {{"bent", 10.0}};
  low.peak = 300e3;
  EXPECT_TRUE(
      test_support::holds(coverageOf({bag("a", {{"flat", 0.0}}), syntheticRecording(low)}, 5).thin.at(0),
                          {"bent", "to 300 kPa only", "600 kPa", "lower limits"}));
  low.peak = 580e3;
  low.cycles = 20;
  EXPECT_TRUE(coverageOf({bag("a", {{"flat", 0.0}}, 20), syntheticRecording(low)}, 5).thin.empty());
}

TEST(Coverage, ReportsTheRangeOfPressure) {
  SyntheticRig low;
  low.peak = 150e3;
  low.cycles = 20;
  EXPECT_EQ(coverageOf({syntheticRecording(low)}, 5).thin.at(0), "no surface was loaded above 150 kPa");
}

TEST(Coverage, ReportsConditionsWithFewCycles) {
  const Coverage coverage = coverageOf({bag("a", {{"flat", 0.0}}, 2)}, 5);
  EXPECT_EQ(coverage.thin.back(), "flat: 2 cycles, fewer than the 5 sections");
}

}  // namespace
}  // namespace fsr::dataset
