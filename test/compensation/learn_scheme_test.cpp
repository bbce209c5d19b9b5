#include "compensation/learn_scheme.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fsr::compensation {
namespace {

constexpr std::size_t kSections = 3;
const std::vector<dataset::CurvatureClass> kFiveClasses = {
    {"flat", {0.0}}, {"r20", {5.0}}, {"r10", {10.0}}, {"r7", {15.0}}, {"r5", {20.0}}};

// One taxel. A reading of code c has the pressure 500 Pa x c x (1 + effect of its class), with 10 kPa of
// noise.
TrainingStatistics statisticsOf(const std::vector<double>& effect) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 10e3);  // [Pa]
  TrainingStatistics statistics{1023, 1, kSections, kFiveClasses, {}, {}};
  for (const double own : effect) {
    for (std::size_t section = 0; section < kSections; ++section) {
      regression::CodeAccumulator readings(1023);
      for (std::uint16_t code = 20; code < 1000; code = static_cast<std::uint16_t>(code + 2)) {
        readings.add(code, regression::toFixed(500.0 * code * (1 + own) + noise(random)));
      }
      statistics.cells.push_back(readings.take());
    }
  }
  return statistics;
}

SchemePlan learn(Scheme scheme, const std::vector<double>& effect) {
  SchemePlan plan = planScheme(scheme, kFiveClasses);
  regression::GrnnOptions grnn;
  grnn.bandwidth = 0.05;
  learnScheme(statisticsOf(effect), grnn, {0}, 1, plan);
  return plan;
}

TEST(LearnScheme, WithoutAnEffectOfBendingAllCurvaturesShareOneModel) {
  const std::vector<double> nothing(5, 0.0);
  EXPECT_GE(learn(Scheme::kScaledCurvature, nothing).curvature_scale, 20.0);
  EXPECT_EQ(learn(Scheme::kCurvatureRanges, nothing).models.size(), 1u);
}

TEST(LearnScheme, WithAnEffectOfBendingTheScaleReachesToTheNeighbours) {
  const double scale = learn(Scheme::kScaledCurvature, {0.0, 0.1, 0.2, 0.3, 0.4}).curvature_scale;
  EXPECT_GT(scale, 0.8);  // with a shorter scale only the nearest class would count between two
  EXPECT_LT(scale, 5.0);  // the distance of two classes
}

TEST(LearnScheme, OnlyNeighboursWithEqualEffectShareARange) {
  const SchemePlan plan = learn(Scheme::kCurvatureRanges, {0.0, 0.3, 0.3, 0.0, 0.0});
  EXPECT_EQ(plan.model_of_class, (std::vector<std::size_t>{0, 1, 1, 2, 2}));
  EXPECT_EQ(plan.models[1].answers_for.surface, "r20 to r10");
  EXPECT_EQ(plan.models[2].trained_on, (std::vector<std::size_t>{3, 4}));
}

TEST(LearnScheme, OtherSchemesLearnNothing) {
  const SchemePlan plan = learn(Scheme::kPerCurvature, std::vector<double>(5, 0.0));
  EXPECT_EQ(plan.models.size(), 5u);
  EXPECT_EQ(plan.curvature_scale, 0.0);
}

TEST(LearnScheme, OneCurvatureHasNoScale) {
  TrainingStatistics statistics = statisticsOf({0.0});
  statistics.classes = {kFiveClasses[0]};
  SchemePlan plan = planScheme(Scheme::kScaledCurvature, statistics.classes);
  learnScheme(statistics, {}, {0}, 1, plan);
  EXPECT_EQ(plan.curvature_scale, 0.0);
}

}  // namespace
}  // namespace fsr::compensation
