#include "discrepancy/fit/taxel_curves_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/driven_rig.h"
#include "support/source_dir.h"
#include "support/synthetic_recording.h"

namespace fsr::discrepancy {
namespace {

// A rig that is unrelated to the simulation. The curves must absorb the whole difference.
DiscrepancyProblem problemOf(test_support::SyntheticRig rig) {
  rig.surfaces = {{"flat", 0.0}, {"bend", 14.25}};
  rig.cycles = 10;
  DiscrepancyProblem problem;
  problem.recordings = {test_support::syntheticRecording(rig)};
  problem.recordings[0].start_ns = 1500000000000000000;
  problem.simulation = simulation::fitted(
      simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/core.yaml"),
      problem.recordings[0]);
  return problem;
}

TEST(TaxelCurvesFit, LeaveNoiseAloneOfASheetWithoutMemory) {
  const DiscrepancyProblem problem = problemOf({});
  const Measured measured = admit(problem);
  const simulation::SimulationSettings curved = withTaxelCurves(measured, problem.simulation, "curves.csv");
  EXPECT_GT(simulatedGap(measured, problem.simulation), 0.05);
  // Uniform noise of +-10 counts: 10 / sqrt(3) / 4095 = 0.00141 rms. The corner at rest is not a straight
  // line.
  EXPECT_NEAR(simulatedGap(measured, curved), 0.00141, 0.0004);
  EXPECT_EQ(curved.taxel_curves_file, "curves.csv");
  EXPECT_EQ(curved.taxel_curves->surfaces.size(), 2u);
}

TEST(TaxelCurvesFit, LeaveALoopToWhoeverExplainsIt) {
  test_support::SyntheticRig rig;
  rig.loop = 200;
  const DiscrepancyProblem problem = problemOf(rig);
  const Measured measured = admit(problem);
  // The branches lie half a loop of 200 counts to either side of the curve.
  const double gap = simulatedGap(measured, withTaxelCurves(measured, problem.simulation, "curves.csv"));
  EXPECT_GT(gap, 0.5 * 100 / 4095);
  EXPECT_LT(gap, 1.2 * 100 / 4095);
}

TEST(TaxelCurvesFit, AreNotFittedToWhatIsShown) {
  DiscrepancyProblem problem = problemOf({});
  const Measured first = admit(problem);
  const simulation::SimulationSettings before = withTaxelCurves(first, problem.simulation, "");
  const double gap = simulatedGap(first, before);
  // Corrupts the counts of all hold-out scans.
  for (std::size_t i = 0; i < problem.recordings[0].scans(); ++i) {
    const double time = problem.recordings[0].time[i];
    for (const MeasuredCycle& cycle : first.cycles) {
      const bool inside = time >= first.time[cycle.first] &&
                          (cycle.last >= first.time.size() || time < first.time[cycle.last]);
      if (cycle.use == CycleUse::kHoldOut && inside) problem.recordings[0].counts[i * 6] = 4000;
    }
  }
  const Measured spoilt = admit(problem);
  const simulation::SimulationSettings after = withTaxelCurves(spoilt, problem.simulation, "");
  EXPECT_EQ(after.taxel_curves->surfaces[0].added, before.taxel_curves->surfaces[0].added);
  EXPECT_GT(simulatedGap(spoilt, after), 2 * gap);
}

}  // namespace
}  // namespace fsr::discrepancy
