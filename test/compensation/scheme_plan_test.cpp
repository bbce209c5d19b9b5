#include "compensation/scheme_plan.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"

namespace fsr::compensation {
namespace {

using Indices = std::vector<std::size_t>;

const std::vector<dataset::CurvatureClass> kPlanClasses = {
    {"socket", {-10.0}}, {"flat", {0.0}}, {"cylinder_7cm", {14.3}}, {"limb", {0.0, 9.0}}};

TEST(SchemePlan, PerCurvatureHasAModelForEachClass) {
  const SchemePlan plan = planScheme(Scheme::kPerCurvature, kPlanClasses);
  ASSERT_EQ(plan.models.size(), 4u);
  EXPECT_EQ(plan.models[2].answers_for.surface, "cylinder_7cm");
  EXPECT_EQ(plan.models[2].trained_on, Indices{2});
  EXPECT_EQ(plan.model_of_class, (Indices{0, 1, 2, 3}));
}

TEST(SchemePlan, BaselineHasOneModelForAllClasses) {
  const SchemePlan plan = planScheme(Scheme::kBaseline, kPlanClasses);
  ASSERT_EQ(plan.models.size(), 1u);
  EXPECT_EQ(plan.models[0].trained_on, (Indices{0, 1, 2, 3}));
  EXPECT_EQ(plan.model_of_class, (Indices{0, 0, 0, 0}));
}

TEST(SchemePlan, FlatOnlyTrainsOnTheFlatClassAndAnswersForAll) {
  const SchemePlan plan = planScheme(Scheme::kFlatOnly, kPlanClasses);
  ASSERT_EQ(plan.models.size(), 1u);
  EXPECT_EQ(plan.models[0].answers_for.surface, "flat");
  EXPECT_EQ(plan.models[0].trained_on, Indices{1});
  EXPECT_EQ(plan.model_of_class, (Indices{0, 0, 0, 0}));
}

TEST(SchemePlan, FlatOnlyNeedsAFlatClass) {
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] {
                                    planScheme(Scheme::kFlatOnly, {kPlanClasses[0], kPlanClasses[2]});
                                  }),
                                  {"scheme is flat_only", "cylinder_7cm", "per_curvature"}));
}

TEST(SchemePlan, FlatOrCurvedHasTwoModels) {
  const SchemePlan plan = planScheme(Scheme::kFlatOrCurved, kPlanClasses);
  ASSERT_EQ(plan.models.size(), 2u);
  EXPECT_EQ(plan.models[0].trained_on, Indices{1});
  EXPECT_EQ(plan.models[1].trained_on, (Indices{0, 2, 3}));
  EXPECT_EQ(plan.model_of_class, (Indices{1, 0, 1, 1}));
}

TEST(SchemePlan, WithASecondInputEveryModelIsTrainedOnAllClasses) {
  const SchemePlan binary = planScheme(Scheme::kBinaryInput, kPlanClasses);
  ASSERT_EQ(binary.models.size(), 2u);
  EXPECT_EQ(binary.models[1].trained_on, (Indices{0, 1, 2, 3}));
  EXPECT_EQ(binary.testedOn(1), (Indices{0, 2, 3}));
  const SchemePlan input = planScheme(Scheme::kCurvatureInput, kPlanClasses);
  ASSERT_EQ(input.models.size(), 4u);
  EXPECT_EQ(input.testedOn(2), Indices{2});
}

TEST(SchemePlan, FlatOrCurvedNeedsFlatAndBentClasses) {
  EXPECT_TRUE(test_support::holds(
      test_support::refusal([&] { planScheme(Scheme::kFlatOrCurved, {kPlanClasses[1]}); }),
      {"scheme is flat_or_curved", "flat_only"}));
}

}  // namespace
}  // namespace fsr::compensation
