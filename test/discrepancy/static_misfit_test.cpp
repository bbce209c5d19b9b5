// Read-outs that limit high readings in other ways than the library's formula, and what looks like it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "discrepancy/answer.h"

namespace fsr::discrepancy {
namespace {

// The answer where `limited` gives each count.
template <typename Limited>
DiscrepancyReport limitedRig(const std::string& rig, Limited limited) {
  return answerTo(planted::problemReading(rig, limited));
}

TEST(StaticMisfit, LimitOfAnyFormIsASaturation) {
  constexpr double kKnee = 1000, kRoom = 900;  // [counts]
  for (const auto limited : {+[](double over) { return kRoom * std::tanh(over / kRoom); },
                             +[](double over) { return over / (1 + over / kRoom); }}) {
    const DiscrepancyReport report = limitedRig(planted::kOneSpeed, [&](const planted::Changed& now) {
      return std::min(now.count, kKnee) + limited(std::max(0.0, now.count - kKnee));
    });
    EXPECT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
    EXPECT_TRUE(inSet(report, "saturation")) << report.sentence;
    EXPECT_LE(report.gap.after, report.gap.before);
  }
}

// Above half of the highest pressure the second surface reads 3 % of full scale more. With a third surface a
// limit cannot explain this; with two it may, and only the gap speaks against it.
TEST(StaticMisfit, StepOfOneSurfaceIsNoSaturation) {
  const std::string third = "  - {surface: cylinder_9cm, cylinder: {radius: 0.09, axis: y}, pause: 300}\n";
  const auto stepped = [](const planted::Changed& now) {
    const double share = 1 - std::abs(1 - 2 * (now.loads - std::floor(now.loads)));
    return now.count + (now.recording == 1 ? 120 / (1 + std::exp((0.5 - share) / 0.02)) : 0);
  };
  for (const std::string& rig :
       {planted::kOneSpeed, planted::rig("chamber: {cycles: 8}\n", planted::kTwoSurfaces + third)}) {
    const DiscrepancyReport report = limitedRig(rig, stepped);
    EXPECT_FALSE(inSet(report, "saturation")) << report.sentence;
    EXPECT_EQ(report.verdict, Verdict::kUnknown) << report.sentence;
    if (rig == planted::kOneSpeed) continue;
    EXPECT_EQ(report.depends_on, (std::vector<std::string>{"pressure", "curvature"}));
  }
}

}  // namespace
}  // namespace fsr::discrepancy
