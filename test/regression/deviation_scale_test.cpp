#include "regression/cross_validation.h"

#include <gtest/gtest.h>

#include <random>

namespace fsr::regression {
namespace {

constexpr std::size_t kCodes = 4096;

// Readings at codes 0 to 3999 with the ratio `draw(code)`.
template <typename Draw>
std::vector<double> factorsOf(std::size_t readings_of_code, Draw draw) {
  DeviationScale scale(std::vector<double>(kCodes, static_cast<double>(readings_of_code)));
  for (std::uint16_t code = 0; code < kCodes; ++code) {
    for (std::size_t i = 0; i < readings_of_code; ++i) scale.add(code, draw(code), 1.0);
  }
  return scale.factors();
}

TEST(DeviationScale, IsOneForNormalErrors) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const double factor : factorsOf(10, [&](int) { return normal(random); }))
    EXPECT_NEAR(factor, 1.0, 0.05);
}

TEST(DeviationScale, FollowsTheErrorsAlongTheCodes) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  // the root mean square was half of what it should be below code 2048, and twice above
  const auto factors =
      factorsOf(10, [&](int code) { return code < 2048 ? 2 * normal(random) : 0.5 * normal(random); });
  EXPECT_NEAR(factors[0], 2.0, 0.2);
  EXPECT_NEAR(factors[1500], 2.0, 0.2);
  EXPECT_NEAR(factors[2600], 0.5, 0.1);
  EXPECT_NEAR(factors[4095], 0.5, 0.1);
}

TEST(DeviationScale, ACodeWithManyReadingsHasItsOwnFactor) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<double> readings(kCodes, 2.0);
  readings[7] = 8192;  // the chamber rests
  DeviationScale scale(readings);
  for (std::uint16_t code = 0; code < kCodes; ++code) {
    for (int i = 0; i < 2; ++i) scale.add(code, normal(random), 1.0);
  }
  scale.add(7, 0.25, 8190.0);
  const auto factors = scale.factors();
  EXPECT_NEAR(factors[7], 0.25, 0.05);
  EXPECT_NEAR(factors[2000], 1.0, 0.15);
}

TEST(DeviationScale, FewReadingsShareOneFactor) {
  const auto factors = factorsOf(0, [](int) { return 0.0; });
  EXPECT_EQ(factors[17], 1.0);
  DeviationScale few(std::vector<double>(kCodes, 0.1));
  few.add(5, 0.5, 100.0);
  few.add(4000, 0.5, 309.6);
  EXPECT_NEAR(few.factors()[2000], 0.5, 0.02);
  EXPECT_EQ(few.factors()[0], few.factors()[4095]);
}

}  // namespace
}  // namespace fsr::regression
