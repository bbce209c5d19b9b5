#include "regression/code_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/readings.h"

namespace fsr::regression {
namespace {

std::vector<Reading> randomReadings(std::size_t number, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Reading> readings(number);
  for (Reading& reading : readings) {
    reading = {static_cast<std::uint16_t>(random() % 4096),
               static_cast<double>(random() % 1000000) * 0.62 - 1e3};
  }
  return readings;
}

TEST(CodeStatistics, ContainCountSumAndSquaresOfEachCode) {
  const CodeStatistics statistics = statisticsOf({{7, 1.5}, {4095, -2.0}, {7, 0.25}});
  std::vector<CodeSums> sums;
  statistics.forEach([&](const CodeSums& code) { sums.push_back(code); });
  ASSERT_EQ(sums.size(), 2u);
  EXPECT_EQ(sums[0].code, 7);
  EXPECT_EQ(sums[0].count, 2u);
  EXPECT_EQ(fromFixed(sums[0].sum), 1.75);
  EXPECT_EQ(static_cast<double>(sums[0].sum_of_squares), (1.5 * 1.5 + 0.25 * 0.25) * std::pow(2.0, 40));
  EXPECT_EQ(sums[1].code, 4095);
  EXPECT_EQ(static_cast<double>(sums[1].sum_of_squares), 4.0 * std::pow(2.0, 40));
  EXPECT_EQ(statistics.samples(), 3u);
}

TEST(CodeStatistics, MergingGivesTheSameBitsInAnyOrder) {
  const auto first = randomReadings(3000, 1);
  const auto second = randomReadings(500, 2);
  auto both = second;
  both.insert(both.end(), first.begin(), first.end());
  const CodeStatistics at_once = statisticsOf(both);

  CodeStatistics forward = statisticsOf(first);
  forward.merge(statisticsOf(second));
  CodeStatistics backward = statisticsOf(second);
  backward.merge(statisticsOf(first));
  EXPECT_TRUE(forward == at_once);
  EXPECT_TRUE(backward == at_once);
  EXPECT_FALSE(statisticsOf(first) == at_once);
}

TEST(CodeStatistics, MergingNothingChangesNothing) {
  CodeStatistics statistics = statisticsOf(randomReadings(100, 3));
  const CodeStatistics before = statistics;
  statistics.merge(CodeStatistics{});
  EXPECT_TRUE(statistics == before);
}

TEST(CodeStatistics, RefuseASumThatOverflows) {
  const CodeSums full{5, 1u << 19, std::numeric_limits<std::int64_t>::max() - 10, 0};
  CodeStatistics a, b;
  a.append(full);
  b.append(full);
  EXPECT_THROW(a.merge(b), settings::InputError);
}

TEST(CodeStatistics, RefuseAPressureOutOfRange) {
  EXPECT_THROW(toFixed(std::nan("")), settings::InputError);
  EXPECT_THROW(toFixed(1e9), settings::InputError);
  EXPECT_EQ(fromFixed(toFixed(-kLargestPressure)), -kLargestPressure);
}

TEST(CodeAccumulator, RefusesACodeAboveFullScale) {
  CodeAccumulator accumulator(1023);
  EXPECT_THROW(accumulator.add(1024, 0), settings::InputError);
}

TEST(CodeAccumulator, IsEmptyAfterTake) {
  CodeAccumulator accumulator(65535);
  accumulator.add(65535, 1);
  EXPECT_EQ(accumulator.take().codes(), 1u);
  EXPECT_TRUE(accumulator.take().empty());
  accumulator.add(65535, 7);
  EXPECT_EQ(accumulator.take().sum().front(), 7);
}

TEST(CodeHistogram, SubtractingUndoesAdding) {
  CodeHistogram histogram(4095);
  const CodeStatistics a = statisticsOf(randomReadings(300, 4));
  const CodeStatistics b = statisticsOf(randomReadings(300, 5));
  histogram.add(a);
  const auto count = histogram.count();
  const auto sum = histogram.sum();
  histogram.add(b);
  histogram.subtract(b);
  EXPECT_EQ(histogram.count(), count);
  EXPECT_EQ(histogram.sum(), sum);
  EXPECT_EQ(histogram.samples(), 300u);
}

}  // namespace
}  // namespace fsr::regression
