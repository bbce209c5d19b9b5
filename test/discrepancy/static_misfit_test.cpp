// Read-outs that limit high readings in other ways than the library's formula, and what looks like it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "discrepancy/answer.h"

namespace fsr::discrepancy {
namespace {

// The answer where `limited` gives each count.
template <typename Limited>
DiscrepancyReport limitedRig(Limited limited) {
  return answerTo(planted::problemReading(planted::kOneSpeed, limited));
}

TEST(StaticMisfit, LimitOfAnyFormIsASaturation) {
  constexpr double kKnee = 1000, kRoom = 900;  // [counts]
  for (const auto limited : {+[](double over) { return kRoom * std::tanh(over / kRoom); },
                             +[](double over) { return over / (1 + over / kRoom); }}) {
    const DiscrepancyReport report = limitedRig([&](const planted::Changed& now) {
      return std::min(now.count, kKnee) + limited(std::max(0.0, now.count - kKnee));
    });
    EXPECT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
    EXPECT_TRUE(inSet(report, "saturation")) << report.sentence;
    EXPECT_LE(report.gap.after, report.gap.before);
  }
}

// Above half of the highest pressure the second surface reads 3 % of full scale more.
TEST(StaticMisfit, StepOfOneSurfaceIsNoSaturation) {
  const DiscrepancyReport report = limitedRig([](const planted::Changed& now) {
    const double share = 1 - std::abs(1 - 2 * (now.loads - std::floor(now.loads)));
    return now.count + (now.recording == 1 ? 120 / (1 + std::exp((0.5 - share) / 0.02)) : 0);
  });
  EXPECT_FALSE(inSet(report, "saturation")) << report.sentence;
  EXPECT_EQ(report.verdict, Verdict::kUnknown) << report.sentence;
}

}  // namespace
}  // namespace fsr::discrepancy
