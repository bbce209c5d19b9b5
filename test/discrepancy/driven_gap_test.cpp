// The gap that a report states is that of its two simulations, driven through the recordings.
#include "discrepancy/prove/driven_gap.h"
#include "discrepancy/prove/recompute_gap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "discrepancy/planted.h"
#include "simulation/settings_text.h"
#include "simulation/taxel_curves.h"

namespace fsr::discrepancy {
namespace {

constexpr double kNoise = 8.0 / 4095;  // white noise of the planted rigs [share of full scale]

// As written into files, with the digits of the files.
simulation::SimulationSettings written(const simulation::SimulationSettings& settings) {
  simulation::SimulationSettings plain = settings;
  plain.taxel_curves.reset();
  plain.taxel_curves_file.clear();
  simulation::SimulationSettings read = simulation::readSimulation(
      settings::Settings::fromText(simulation::simulationText(plain), "written.yaml"));
  read.taxel_curves = settings.taxel_curves;
  return read;
}

void expectRecomputable(const DiscrepancyProblem& problem, const DiscrepancyReport& report) {
  const std::pair<simulation::SimulationSettings, bool> sides[] = {{report.base, false},
                                                                   {report.added, true}};
  for (const auto& [settings, after] : sides) {
    const RecomputedGap again = recomputeGap(problem.recordings, report.hold_out, written(settings));
    const double stated = after ? report.gap.after : report.gap.before;
    EXPECT_NEAR(again.rms, stated, 1e-3 * stated) << after;
    ASSERT_EQ(again.surfaces.size(), report.gap.surfaces.size());
    for (std::size_t s = 0; s < again.surfaces.size(); ++s) {
      const SurfaceGap& surface = report.gap.surfaces[s];
      EXPECT_EQ(again.surfaces[s].first, surface.surface);
      EXPECT_NEAR(again.surfaces[s].second, after ? surface.after : surface.before, 1e-3 * stated);
    }
  }
}

TEST(DrivenGap, IsThatOfTheTwoSimulations) {
  const DiscrepancyProblem problem =
      planted::problem(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.06}\n");
  const DiscrepancyReport report = investigate(problem);
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  expectRecomputable(problem, report);
  EXPECT_NEAR(report.gap.after, kNoise, 0.05 * kNoise);
  EXPECT_NEAR(report.gap.closed, 1, 0.01);
  EXPECT_EQ(report.gap.left_out, 0u);
  ASSERT_EQ(report.gap.covered.size(), 3u);
  EXPECT_NEAR(report.gap.covered[0].pressure.high, 620e3, 3e3);
}

// A loop that acts on one row of taxels or on the bent surfaces only must do the same in the simulation.
TEST(DrivenGap, OfAnEffectThatActsInSomePlacesOnly) {
  for (const char* where : {"only_surfaces: [cylinder_9cm, cylinder_5cm]", "only_taxels: [4, 5, 6, 7]"}) {
    const DiscrepancyProblem problem = planted::problem(
        planted::kTwoSpeeds, std::string("  hysteresis: {loop_width: 0.08, ") + where + "}\n");
    const DiscrepancyReport report = investigate(problem);
    ASSERT_FALSE(report.effects.empty()) << where << ": " << report.sentence;
    expectRecomputable(problem, report);
    EXPECT_LT(report.gap.after, 0.7 * report.gap.before) << where;
  }
}

// The widest loop that its formula permits, on one taxel. What was fitted to the mean taxel, times the number
// of taxels, is a little wider than that.
TEST(DrivenGap, OfALoopAsWideAsItsFormulaPermits) {
  const DiscrepancyProblem problem = planted::problem(
      planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.1505, reach: 80000, only_taxels: [4]}\n");
  const DiscrepancyReport report = investigate(problem);
  ASSERT_EQ(report.effects.at(0).id, "hysteresis") << report.sentence;
  expectRecomputable(problem, report);
  EXPECT_LT(report.gap.after, 0.7 * report.gap.before);
  const auto& said = report.limitations;
  EXPECT_EQ(std::count_if(said.begin(), said.end(),
                          [](const std::string& text) {
                            return text.find("than its formula permits") != std::string::npos;
                          }),
            1);
}

// Nothing is hidden. The gap is the noise, the floor as well, and no share of it is closed.
TEST(DrivenGap, OfNothingIsTheNoise) {
  const DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  const DiscrepancyReport report = investigate(problem);
  ASSERT_EQ(report.verdict, Verdict::kNone) << report.sentence;
  expectRecomputable(problem, report);
  EXPECT_NEAR(report.gap.before, kNoise, 0.05 * kNoise);
  EXPECT_EQ(report.gap.before, report.gap.after);
  EXPECT_NEAR(report.gap.floor_bracket.low, kNoise, 0.05 * kNoise);
  EXPECT_NEAR(report.gap.floor_bracket.high, kNoise, 0.1 * kNoise);
  EXPECT_TRUE(std::isnan(report.gap.closed));
  EXPECT_TRUE(std::isnan(report.gap.closed_interval.low));
}

// A column that fails at random: the simulation fails at other times, so nothing is closed.
TEST(DrivenGap, OfALooseColumnIsNotCalledClosed) {
  const DiscrepancyProblem problem = planted::problem(
      planted::withMatrix(5, 6), "  column_fault: {share: 0.04, line: 1, burst: 3, depth: 0.7}\n");
  const DiscrepancyReport report = investigate(problem);
  ASSERT_FALSE(report.effects.empty()) << report.sentence;
  ASSERT_EQ(report.effects.at(0).id, "column_fault");
  expectRecomputable(problem, report);
  EXPECT_GT(report.gap.after, 0.9 * report.gap.before);
  EXPECT_TRUE(std::isnan(report.gap.closed));
  ASSERT_FALSE(report.gap.missing.empty());
  EXPECT_NE(report.gap.missing.back().find("random"), std::string::npos);
}

// Each surface has a cycle whose peak is a quarter higher than that of all others. Where it is held out, the
// curves were not fitted to its pressures.
TEST(DrivenGap, IsNotThatOfCurvesThatNoDataDetermine) {
  DiscrepancyProblem problem;
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
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
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
  DiscrepancyProblem problem =
      planted::problem(std::string(planted::kOneSurface)
                           .replace(std::string(planted::kOneSurface).find("cycles: 16"), 10, "cycles: 4"),
                       "  hysteresis: {loop_width: 0.06}\n");
  const DiscrepancyReport report = investigate(problem);
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
  DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "  creep: {per_decade: 0.04}\n");
  for (dataset::Recording& recording : problem.recordings)
    recording.start_ns = problem.recordings[0].start_ns;
  const DiscrepancyReport report = investigate(problem);
  expectRecomputable(problem, report);
}

}  // namespace
}  // namespace fsr::discrepancy
