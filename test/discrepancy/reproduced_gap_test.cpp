// The difference between simulate --drive and the recordings is the gap that the report states.
#include <gtest/gtest.h>

#include <cmath>

#include "discrepancy/fit/taxel_curves_fit.h"
#include "simulation/read_settings.h"
#include "simulation/session.h"

namespace fsr::discrepancy {
namespace {

constexpr double kAlike = 0.15;  // the report fits splines, the simulation hat functions of pressure

const char* const kSession = R"(
simulation: planted
seed: 7
matrix: {rows: 2, columns: 3}
board: {scan_rate: 2.5, transducer_rate: 2.5}
program:
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 5}
  - cycles: {peak: 620000, rate: 8000, dwell_peak: 8, cycles: 2}
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 3}
session:
  - {surface: flat, flat: true}
  - {surface: cylinder_5cm, cylinder: {radius: 0.05, axis: y}, pause: 300}
effects:
  static_curve: {conductance: 3.2e-4, exponent: 0.85, conductance_scatter: 0.05}
  bending_preload: {amplitude: 30000}
  bending_gain: {change: -0.15}
  white_noise: {absolute: 8}
  converter: {}
)";

simulation::SimulationSettings simulation(const std::string& more) {
  return simulation::readSimulation(settings::Settings::fromText(kSession + more, "planted.yaml"));
}

TEST(ReproducedGap, IsTheStatedOneBeforeAndAfter) {
  DiscrepancyProblem problem;
  problem.simulation = simulation("");
  problem.recordings = simulation::simulateSession(simulation("  hysteresis: {loop_width: 0.06}\n"));
  const DiscrepancyReport report = investigate(problem);
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  const Measured measured = admit(problem);
  const double before = simulatedGap(measured, report.base), after = simulatedGap(measured, report.added);
  EXPECT_NEAR(before, report.gap.before, kAlike * report.gap.before);
  EXPECT_NEAR(after, report.gap.after, kAlike * report.gap.after);
}

// A loop that acts on one row of taxels or on one bent surface only must do the same in the simulation.
TEST(ReproducedGap, OfAnEffectThatActsInSomePlacesOnly) {
  for (const char* where : {"only_surfaces: [cylinder_5cm]", "only_taxels: [3, 4, 5]"}) {
    DiscrepancyProblem problem;
    problem.simulation = simulation("");
    problem.recordings = simulation::simulateSession(
        simulation(std::string("  hysteresis: {loop_width: 0.08, ") + where + "}\n"));
    const DiscrepancyReport report = investigate(problem);
    ASSERT_FALSE(report.effects.empty()) << report.sentence;
    const Measured measured = admit(problem);
    EXPECT_NEAR(simulatedGap(measured, report.base), report.gap.before, kAlike * report.gap.before) << where;
    EXPECT_NEAR(simulatedGap(measured, report.added), report.gap.after, 1.5 * kAlike * report.gap.after)
        << where;
    EXPECT_LT(report.gap.after, 0.7 * report.gap.before) << where;
  }
}

}  // namespace
}  // namespace fsr::discrepancy
