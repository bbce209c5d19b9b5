#include "compensation/blend_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/allocation_guard.h"

namespace fsr::compensation {
namespace {

constexpr std::size_t kCodes = 600;  // more than one block

// One taxel on classes of 0, 10 and 20 1/m: linear tables of 100 Pa a count times a gain, plus a preload.
class BlendTable : public testing::Test {
 protected:
  BlendTable() {
    tables.codes = kCodes;
    tables.curvature = {0, 10, 20};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t code = 0; code < kCodes; ++code) {
        entries[k].push_back(
            {static_cast<float>(gain[k] * 100.0 * static_cast<double>(code) - preload[k]), deviation[k]});
        log_weight[k].push_back(-0.001f * static_cast<float>(code) * static_cast<float>(k));
      }
      tables.table.push_back(entries[k].data());
      tables.log_weight.push_back(log_weight[k].data());
    }
  }
  std::vector<TableEntry> at(double curvature, std::size_t chosen = 0) {
    std::vector<TableEntry> out(kCodes);
    blendTable(rule, 5.0, tables, curvature, chosen, out.data());
    return out;
  }

  const double gain[3] = {1.0, 1.2, 1.3};
  const double preload[3] = {0, 4e3, 6e3};  // [Pa]
  const float deviation[3] = {300, 400, 500};
  std::vector<TableEntry> entries[3];
  std::vector<float> log_weight[3];
  TaxelTables tables;
  CurvatureRule rule;
};

TEST_F(BlendTable, InterpolatesBetweenTheNeighboursTables) {
  rule.blend = BlendRule::kInterpolate;
  EXPECT_FLOAT_EQ(at(2.5)[500].pressure, 0.75f * entries[0][500].pressure + 0.25f * entries[1][500].pressure);
  EXPECT_FLOAT_EQ(at(17)[10].pressure, 0.3f * entries[1][10].pressure + 0.7f * entries[2][10].pressure);
  EXPECT_EQ(at(10)[500].pressure, entries[1][500].pressure);
}

TEST_F(BlendTable, UsesTheOuterClassBeyondIt) {
  rule.blend = BlendRule::kInterpolate;
  EXPECT_EQ(at(23)[500].pressure, entries[2][500].pressure);
  EXPECT_EQ(at(-2)[500].pressure, entries[0][500].pressure);
}

TEST_F(BlendTable, UsesTheChosenClassWithTheNearestRule) {
  EXPECT_EQ(at(4.9, 1)[500].pressure, entries[1][500].pressure);  // as with hysteresis
}

TEST_F(BlendTable, FollowsTheLawBetweenTheClasses) {
  // a law that agrees with the classes at its knots and is not linear between them
  rule.blend = BlendRule::kInterpolate;
  rule.law = {{0, 10, 20}, {1.0, 1.2, 1.3}, {0, -4e3, -6e3}};
  const EffectLaw::Effect law = rule.law.at(4);
  EXPECT_GT(law.gain, 1.08);  // that of the straight line
  for (const std::size_t code : {0, 100, 500}) {
    EXPECT_NEAR(at(4)[code].pressure, law.gain * 100.0 * static_cast<double>(code) + law.offset, 0.01);
  }
  EXPECT_EQ(at(20)[500].pressure, entries[2][500].pressure);
}

TEST_F(BlendTable, WeightsKernelsByReadingAndCurvature) {
  // by hand: weights exp(log_weight - (at - curvature)^2 / 2 5^2)
  rule.blend = BlendRule::kKernel;
  for (const std::size_t code : {5, 300, 599}) {
    double sum = 0, weight = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double away = 8 - tables.curvature[k];
      const double share = std::exp(log_weight[k][code] - away * away / 50);
      sum += share * entries[k][code].pressure;
      weight += share;
    }
    EXPECT_NEAR(at(8)[code].pressure / (sum / weight), 1.0, 1e-5);
  }
}

TEST_F(BlendTable, UsesTheNearestSampleWhereKernelsUnderflow) {
  rule.blend = BlendRule::kKernel;
  for (std::size_t k = 0; k < 3; ++k) log_weight[k].assign(kCodes, k == 2 ? -1e6f : -2e6f);
  EXPECT_EQ(at(1)[500].pressure, entries[2][500].pressure);
}

TEST_F(BlendTable, IgnoresAClassWithoutCurvature) {
  tables.curvature[1] = NAN;
  rule.blend = BlendRule::kInterpolate;
  EXPECT_FLOAT_EQ(at(10)[500].pressure, 0.5f * (entries[0][500].pressure + entries[2][500].pressure));
  rule.blend = BlendRule::kKernel;
  log_weight[1].assign(kCodes, 100.0f);
  EXPECT_LT(at(10)[500].pressure, entries[2][500].pressure);
  EXPECT_GT(at(10)[500].pressure, entries[0][500].pressure);
}

TEST_F(BlendTable, TheDeviationIsLargerBetweenClasses) {
  const double half = 0.5 * (entries[1][500].pressure - entries[0][500].pressure);
  EXPECT_EQ(at(10, 1)[500].deviation, deviation[1]);
  EXPECT_FLOAT_EQ(at(5)[500].deviation,
                  static_cast<float>(std::sqrt(0.5 * 300 * 300 + 0.5 * 400 * 400 + half * half)));
  rule.unseen = {{0, 50e3}, {1e3, 5e3}};
  EXPECT_FLOAT_EQ(at(5)[250].deviation,  // at 25 kPa, midway between the knots
                  static_cast<float>(std::sqrt(0.5 * 300 * 300 + 0.5 * 400 * 400 + 3e3 * 3e3)));
  EXPECT_LT(at(1)[500].deviation, at(3)[500].deviation);
}

TEST_F(BlendTable, TheDeviationIncreasesBeyondTheClasses) {
  const double last = entries[2][500].pressure - entries[1][500].pressure;
  rule.unseen = {{0}, {0}};
  EXPECT_EQ(at(20, 2)[500].deviation, deviation[2]);
  EXPECT_FLOAT_EQ(at(25, 2)[500].deviation, static_cast<float>(std::sqrt(500.0 * 500 + 0.25 * last * last)));
  EXPECT_GT(at(-5)[500].deviation, at(-2)[500].deviation);
}

TEST_F(BlendTable, ATaxelWithoutAModelHasNone) {
  entries[0].assign(kCodes, {NAN, NAN});
  rule.blend = BlendRule::kInterpolate;
  EXPECT_TRUE(std::isnan(at(5)[7].pressure));
}

TEST_F(BlendTable, AllocatesNothing) {
  std::vector<TableEntry> out(kCodes);
  rule.law = {{0, 10, 20}, {1.0, 1.2, 1.3}, {0, -4e3, -6e3}};
  for (const BlendRule blend : {BlendRule::kNearest, BlendRule::kKernel, BlendRule::kInterpolate}) {
    rule.blend = blend;
    const test_support::AllocationGuard guard;
    blendTable(rule, 5.0, tables, 7.0, 1, out.data());
    EXPECT_EQ(guard.allocations(), 0u);
  }
}

TEST(EffectLawCurve, IsMonotoneBetweenItsKnots) {
  const EffectLaw law{{-10, 0, 1, 20}, {0.8, 1.0, 1.5, 1.6}, {0, 0, 1, 1}};
  double last = 0;
  for (double k = -12; k < 22; k += 0.125) {
    EXPECT_GE(law.at(k).gain, last);
    last = law.at(k).gain;
  }
  EXPECT_EQ(law.at(1).gain, 1.5);
  EXPECT_EQ(law.at(-11).gain, 0.8);
  EXPECT_EQ(law.at(15).offset, 1.0);  // no overshoot
}

}  // namespace
}  // namespace fsr::compensation
