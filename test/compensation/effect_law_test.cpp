#include "compensation/effect_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fsr::compensation {
namespace {

constexpr std::size_t kLawCodes = 400;

// P = gain * curve + offset, trained on codes 50 to 350.
regression::CodeTable tableOf(double gain, double offset) {
  regression::CodeTable table;
  for (std::size_t code = 0; code < kLawCodes; ++code) {
    const double curve = 2.0 * std::pow(static_cast<double>(code), 2);  // [Pa]
    table.pressure.push_back(static_cast<float>(gain * curve + offset));
  }
  table.lowest = 50;
  table.highest = 350;
  return table;
}

TEST(EffectLaw, FindsTheEffectOfBendingOnATaxel) {
  const std::vector<regression::CodeTable> tables = {tableOf(0.8, 3e3), tableOf(1.0, 0),
                                                     tableOf(1.2, -3e3)};  // mean: 1, 0
  const TaxelEffect effect = effectOf(tables.data(), 3);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(effect.gain[k], 0.8 + 0.2 * static_cast<double>(k), 1e-6);
    EXPECT_NEAR(effect.offset[k], 3e3 - 3e3 * static_cast<double>(k), 0.05);
  }
}

TEST(EffectLaw, ATaxelWithoutAModelHasNoEffect) {
  std::vector<regression::CodeTable> tables = {tableOf(1, 0), tableOf(1, 0)};
  tables[1].pressure.assign(kLawCodes, NAN);
  EXPECT_TRUE(effectOf(tables.data(), 2).gain.empty());
  std::vector<regression::CodeTable> apart = {tableOf(1, 0), tableOf(1, 0)};
  apart[0].highest = 40;  // no common code
  EXPECT_TRUE(effectOf(apart.data(), 2).gain.empty());
}

const std::vector<dataset::CurvatureClass> kLawClasses = {
    {"socket", {-10.0}}, {"flat", {0.0}}, {"a", {7.0}}, {"b", {10.0}}, {"c", {20.0}}};

TEST(EffectLaw, IsTheMeanOfTheTaxelsMadeMonotoneOnEitherSide) {
  const std::vector<TaxelEffect> taxels = {{{1.2, 1.0, 1.1, 1.4, 1.3}, {0, 0, -1, -2, -3}},
                                           {{1.2, 1.0, 1.3, 1.4, 1.3}, {0, 0, -3, -2, -5}},
                                           {{}, {}}};
  const EffectLaw law = learnLaw(kLawClasses, taxels);
  EXPECT_EQ(law.curvature, (std::vector<double>{-10, 0, 7, 10, 20}));
  const std::vector<double> gain = {1.2, 1.0, 1.2, 1.35, 1.35};  // 1.4 and 1.3 are pooled
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(law.gain[k], gain[k], 1e-12);
  EXPECT_EQ(law.offset, (std::vector<double>{0, 0, -2, -2, -4}));
  EXPECT_EQ(learnLaw(kLawClasses, taxels, 3).curvature, (std::vector<double>{-10, 0, 7, 20}));
}

TEST(EffectLaw, NeedsThreeUniformClasses) {
  const std::vector<TaxelEffect> taxels = {{{1.0, 1.1, 1.2}, {0, 0, 0}}};
  EXPECT_TRUE(learnLaw({{"flat", {0.0}}, {"limb", {5.0, 9.0}}, {"bend", {20.0}}}, taxels).curvature.empty());
  EXPECT_EQ(learnLaw({{"flat", {0.0}}, {"limb", {5.0}}, {"bend", {20.0}}}, taxels).curvature.size(), 3u);
}

}  // namespace
}  // namespace fsr::compensation
