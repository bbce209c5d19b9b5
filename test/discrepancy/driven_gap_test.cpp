// The gap that a report states is that of its two simulations, driven through the recordings.
#include "discrepancy/prove/driven_gap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "discrepancy/answer.h"

namespace fsr::discrepancy {
namespace {

// A loop that acts on the bent surfaces only must do the same in the simulation.
TEST(DrivenGap, OfAnEffectThatActsOnSomeSurfacesOnly) {
  const DiscrepancyReport report = answerTo(
      planted::problem(planted::kTwoSpeeds,
                       "  hysteresis: {loop_width: 0.08, only_surfaces: [cylinder_9cm, cylinder_5cm]}\n"));
  ASSERT_FALSE(report.effects.empty()) << report.sentence;
  EXPECT_LT(report.gap.after, 0.7 * report.gap.before);
}

// The widest loop that its formula permits, on one taxel. What was fitted to the mean taxel, times the number
// of taxels, is a little wider than that.
TEST(DrivenGap, OfALoopAsWideAsItsFormulaPermits) {
  const DiscrepancyReport report = answerTo(planted::problem(
      planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.1505, reach: 80000, only_taxels: [4]}\n"));
  ASSERT_EQ(report.effects.at(0).id, "hysteresis") << report.sentence;
  EXPECT_LT(report.gap.after, 0.7 * report.gap.before);
  const auto& said = report.limitations;
  EXPECT_EQ(std::count_if(said.begin(), said.end(),
                          [](const std::string& text) {
                            return text.find("than its formula permits") != std::string::npos;
                          }),
            1);
}

// Each surface has a cycle whose peak is a quarter higher than that of all others. Where it is held out, the
// curves were not fitted to its pressures.
TEST(DrivenGap, IsNotThatOfCurvesThatNoDataDetermine) {
  const char* const kUneven = R"(
simulation: planted
seed: 7
matrix: {rows: 3, columns: 4}
board: {scan_rate: 2.5, transducer_rate: 2.5}
program:
  - cycles: {peak: 450000, rate: 40000, dwell_peak: 8, cycles: 5}
  - cycles: {peak: 600000, rate: 40000, dwell_peak: 8, cycles: 1}
  - cycles: {peak: 450000, rate: 20000, dwell_peak: 8, cycles: 4}
session:
  - {surface: flat, flat: true}
  - {surface: cylinder_9cm, cylinder: {radius: 0.09, axis: y}, pause: 300}
effects:
  static_curve: {conductance: 3.2e-4, exponent: 0.6, conductance_scatter: 0.05}
  bending_preload: {amplitude: 30000}
  white_noise: {absolute: 8}
  converter: {}
)";
  std::size_t left_out = 0;
  for (std::uint64_t seed = 1; seed <= 8 && left_out == 0; ++seed) {
    DiscrepancyProblem uneven = planted::problem(kUneven, "");
    uneven.options.seed = seed;
    const DiscrepancyReport report = investigate(uneven);
    EXPECT_LT(report.gap.before, 1.2 * kNoise) << seed;
    left_out += report.gap.left_out;
  }
  EXPECT_GT(left_out, 0u) << "in none of the draws the high cycle was held out";
}

// Four cycles: no fifth of them is a cycle.
TEST(DrivenGap, IsNotKnownWhereNothingWasHeldOut) {
  const DiscrepancyReport report = answerTo(planted::problem(
      std::string(planted::kOneSurface).replace(planted::kOneSurface.find("cycles: 16"), 10, "cycles: 4"),
      "  hysteresis: {loop_width: 0.06}\n"));
  EXPECT_TRUE(std::isnan(report.gap.before));
  EXPECT_TRUE(std::isnan(report.gap.after));
  EXPECT_TRUE(std::isnan(report.gap.closed));
  EXPECT_TRUE(report.hold_out.empty());
  EXPECT_TRUE(report.effects.empty());
  EXPECT_TRUE(report.credible_set.empty());
  EXPECT_EQ(report.verdict, Verdict::kUnknown);
  EXPECT_FALSE(report.depends_on.empty());
  EXPECT_NE(report.sentence.find("nothing was held out"), std::string::npos) << report.sentence;
  ASSERT_EQ(report.gap.missing.size(), 1u);
  EXPECT_EQ(report.gap.missing[0].find("Nothing was held out"), 0u);
}

// Two tables that were converted into bags begin at the same date.
TEST(DrivenGap, StartsWithANewSheetWhereRecordingsOverlap) {
  DiscrepancyProblem problem = planted::problem(planted::rig("chamber: {cycles: 5}\n", planted::kTwoSurfaces),
                                                "  hysteresis: {loop_width: 0.05}\n");
  for (dataset::Recording& recording : problem.recordings)
    recording.start_ns = problem.recordings[0].start_ns;
  answerTo(problem);
}

}  // namespace
}  // namespace fsr::discrepancy
