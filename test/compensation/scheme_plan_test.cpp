#include "fsr_pressure_map/compensation/scheme_plan.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/regression/grnn.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr {
namespace {

using Indices = std::vector<std::size_t>;

const std::vector<CurvatureClass> kClasses = {
    {"socket", {-10.0}}, {"flat", {0.0}}, {"cylinder_7cm", {14.3}}, {"limb", {0.0, 9.0}}};

TEST(SchemePlan, PerCurvatureHasAModelForEachClass) {
  const SchemePlan plan = planScheme(Scheme::kPerCurvature, kClasses);
  ASSERT_EQ(plan.models.size(), 4u);
  EXPECT_EQ(plan.models[2].answers_for.surface, "cylinder_7cm");
  EXPECT_EQ(plan.models[2].trained_on, Indices{2});
  EXPECT_EQ(plan.model_of_class, (Indices{0, 1, 2, 3}));
}

TEST(SchemePlan, BaselineHasOneModelOfEverything) {
  const SchemePlan plan = planScheme(Scheme::kBaseline, kClasses);
  ASSERT_EQ(plan.models.size(), 1u);
  EXPECT_EQ(plan.models[0].trained_on, (Indices{0, 1, 2, 3}));
  EXPECT_EQ(plan.model_of_class, (Indices{0, 0, 0, 0}));
}

TEST(SchemePlan, FlatOnlyTrainsOnTheFlatClassAndAnswersForAll) {
  const SchemePlan plan = planScheme(Scheme::kFlatOnly, kClasses);
  ASSERT_EQ(plan.models.size(), 1u);
  EXPECT_EQ(plan.models[0].answers_for.surface, "flat");
  EXPECT_EQ(plan.models[0].trained_on, Indices{1});
  EXPECT_EQ(plan.model_of_class, (Indices{0, 0, 0, 0}));
}

TEST(SchemePlan, FlatOnlyNeedsAFlatClass) {
  try {
    planScheme(Scheme::kFlatOnly, {kClasses[0], kClasses[2]});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "scheme is flat_only, but no recording is of a flat surface (there is socket, cylinder_7cm); "
        "add one, or choose baseline or per_curvature");
  }
}

CodeStatistics reading(std::uint16_t code, double pressure) {
  CodeStatistics statistics;
  const FixedPressure fixed = toFixed(pressure);
  statistics.append({code, 1, fixed, Int128{fixed} * fixed});
  return statistics;
}

TEST(SchemePlan, AModelPoolsItsClassesSectionBySection) {
  TrainingStatistics statistics{4095, 1, 2, {{"flat", {0.0}}, {"bent", {10.0}}}, {}};
  statistics.cells = {reading(100, 1e3), reading(2000, 20e3), reading(100, 3e3), reading(2000, 40e3)};
  const SchemePlan plan = planScheme(Scheme::kBaseline, statistics.classes);
  const auto models = fitTaxel(plan, statistics, 0, Grnn(), HeldOutDeviation::kNo);
  ASSERT_EQ(models.size(), 1u);
  EXPECT_EQ(models[0].table.pressure[100], 2e3f);
  EXPECT_EQ(models[0].table.pressure[2000], 30e3f);
  // without section 0, which held both readings of code 100
  EXPECT_EQ(models[0].held_out[0].pressure[100], 30e3);
}

}  // namespace
}  // namespace fsr
