// The first loads on each surface read low. Noise with a gain of each cycle could take this up.
#include <gtest/gtest.h>

#include "discrepancy/decide/cycle_gains.h"
#include "drawn_design.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "planted.h"

namespace fsr::discrepancy {
namespace {

using Ids = std::vector<std::string>;

DiscrepancyReport found(double (*gain)(double loads)) {
  return investigate(planted::problemReading(
      planted::kTwoSpeeds, [&](const planted::Changed& now) { return now.count * gain(now.loads); }));
}

TEST(FirstLoads, ThatReadLowLikeAHyperbolaAreABreakIn) {
  const DiscrepancyReport report = found([](double loads) { return 1 - 0.06 / (1 + std::floor(loads)); });
  ASSERT_FALSE(report.credible_set.empty()) << report.sentence;
  EXPECT_EQ(report.credible_set.front(), Ids{"break_in"}) << report.sentence;
  EXPECT_LT(report.gap.after, 0.3 * report.gap.before);
}

TEST(FirstLoads, OfWhichOnlyTheFirstReadsLowAreABreakIn) {
  const DiscrepancyReport report = found([](double loads) { return loads < 0.9 ? 0.95 : 1; });
  ASSERT_FALSE(report.credible_set.empty()) << report.sentence;
  EXPECT_EQ(report.credible_set.front(), Ids{"break_in"}) << report.sentence;
}

// Few cycles show it, so the delay alone predicts the readings hardly worse on average.
TEST(FirstLoads, ThatReadLowAreSeenBesideADelay) {
  const DiscrepancyReport report = investigate(
      planted::problem(planted::kTwoSpeeds, "  time_skew: {delay: 1.0}\n  break_in: {change: -0.03}\n"));
  ASSERT_FALSE(report.credible_set.empty()) << report.sentence;
  EXPECT_EQ(report.credible_set.front(), (Ids{"time_skew", "break_in"})) << report.sentence;
  EXPECT_LT(report.gap.after, 0.12 * report.gap.before) << "the delay alone leaves 14 %";
}

TEST(FirstLoads, ThatReadAsOthersAreNotSeenBesideADelay) {
  const DiscrepancyReport report =
      investigate(planted::problem(planted::kTwoSpeeds, "  time_skew: {delay: 1.0}\n"));
  ASSERT_FALSE(report.credible_set.empty()) << report.sentence;
  EXPECT_EQ(report.credible_set.front(), Ids{"time_skew"}) << report.sentence;
}

// Least chance of a slow effect whose signature is a gain that fades over three cycles. The gain of each
// cycle of one mount is `size` times this signature, plus noise.
double chanceOfFading(double size, std::uint64_t seed) {
  CycleDesign design =
      drawn::design({24, 20, 1, 14, {[](const drawn::Place& place) {
                       return drawn::straight(place.share) * std::exp(-static_cast<double>(place.cycle) / 3);
                     }}});
  const statistics::RandomStream noise = statistics::randomStream(seed, "gains");
  for (CycleBins& bins : design.cycles) {
    const double gain =
        size * std::exp(-static_cast<double>(bins.cycle) / 3) + 0.01 * noise.normal(bins.cycle);
    bins.reading += gain * bins.net;
  }
  Explaining slow{{"break_in"}, {{{0}, {true}, false, false}}, {}, true};
  return chanceByGains(design, {slow}, 299, 1).front();
}

TEST(ChanceByGains, IsThatOfChanceWhereGainsAreNoise) {
  int rare = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) rare += chanceOfFading(0, seed) <= 0.05;
  // 5 of 100 on average; 12 or more have a probability of 0.4 %: 1 - pbinom(11, 100, 0.05) in R.
  EXPECT_LE(rare, 11);
  EXPECT_GE(rare, 1);
}

TEST(ChanceByGains, IsSmallWhereTheGainsFade) {
  EXPECT_LE(chanceOfFading(-0.1, 3), 0.01);
}

}  // namespace
}  // namespace fsr::discrepancy
