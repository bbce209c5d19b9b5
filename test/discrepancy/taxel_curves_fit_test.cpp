#include "discrepancy/fit/taxel_curves_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "discrepancy/prove/recompute_gap.h"
#include "simulation/effects/effect_library.h"
#include "simulation/rig.h"
#include "simulation/taxel_curves.h"
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

// Of one simulation on the hold-out scans.
double gapOf(const DiscrepancyProblem& problem, const simulation::SimulationSettings& simulation) {
  const Measured measured = admit(problem);
  return recomputeGap(problem.recordings, HoldOutView(measured, FitView(measured)).spans(), simulation).rms;
}

simulation::SimulationSettings curved(const DiscrepancyProblem& problem) {
  const Measured measured = admit(problem);
  return withTaxelCurves(FitView(measured), problem.simulation, "curves.csv");
}

TEST(TaxelCurvesFit, LeaveNoiseAloneOfASheetWithoutMemory) {
  const DiscrepancyProblem problem = problemOf({});
  const simulation::SimulationSettings with = curved(problem);
  EXPECT_GT(gapOf(problem, problem.simulation), 0.05);
  // Uniform noise of +-10 counts: 10 / sqrt(3) / 4095 = 0.00141 rms.
  EXPECT_NEAR(gapOf(problem, with), 0.00141, 0.0004);
  EXPECT_EQ(with.taxel_curves_file, "curves.csv");
  EXPECT_EQ(with.taxel_curves->surfaces.size(), 2u);
}

TEST(TaxelCurvesFit, LeaveALoopToWhoeverExplainsIt) {
  test_support::SyntheticRig rig;
  rig.loop = 200;
  const DiscrepancyProblem problem = problemOf(rig);
  // The branches lie half a loop of 200 counts to either side of the curve.
  const double gap = gapOf(problem, curved(problem));
  EXPECT_GT(gap, 0.5 * 100 / 4095);
  EXPECT_LT(gap, 1.2 * 100 / 4095);
}

TEST(TaxelCurvesFit, AreNotFittedToWhatIsHeldOut) {
  DiscrepancyProblem problem = problemOf({});
  const simulation::SimulationSettings before = curved(problem);
  const double gap = gapOf(problem, before);
  const Measured measured = admit(problem);
  const HoldOutView hold_out(measured, FitView(measured));
  for (std::size_t i = 0; i < problem.recordings[0].scans(); ++i) {
    if (hold_out.sampleOf(0, i) != HoldOutView::kNotInView) problem.recordings[0].counts[i * 6] = 4000;
  }
  const simulation::SimulationSettings after = curved(problem);
  EXPECT_EQ(after.taxel_curves->surfaces[0].added, before.taxel_curves->surfaces[0].added);
  EXPECT_GT(gapOf(problem, after), 2 * gap);
}

// Readings of a taxel as the chamber's pressure rises from 0 far beyond the fitted pressures.
std::vector<double> readingsOf(const simulation::SimulationSettings& settings, std::size_t taxel) {
  simulation::SensorChain chain(simulation::withoutNoise(settings));
  simulation::RigSample sample;
  std::vector<double> readings;
  for (sample.pressure = 0; sample.pressure <= 900e3; sample.pressure += 5e3) {
    chain.read(sample);
    readings.push_back(chain.reading()[taxel]);
    sample.time += 1;
  }
  return readings;
}

TEST(TaxelCurvesFit, NeverFall) {
  test_support::SyntheticRig rig;
  rig.noise = 200;  // so that a free spline falls
  const simulation::SimulationSettings with = curved(problemOf(rig));
  for (std::size_t taxel = 0; taxel < 6; ++taxel) {
    const std::vector<double> readings = readingsOf(with, taxel);
    for (std::size_t k = 1; k < 120; ++k) EXPECT_GE(readings[k], readings[k - 1] - 0.5) << taxel << " " << k;
  }
}

TEST(TaxelCurvesFit, AreStraightBeyondTheFittedLoads) {
  const DiscrepancyProblem problem = problemOf({});
  const auto with = curved(problem).taxel_curves;
  const auto& flat = with->surfaces.front();
  const simulation::LoadCurves curves(flat, 6);
  const double end = flat.load.back();
  const double near = curves.at(0, end + 10e3) - curves.at(0, end);
  EXPECT_NEAR(curves.at(0, end + 100e3) - curves.at(0, end), 10 * near, 1e-9);
}

// A taxel that one bag masks is fitted to the other bags alone.
TEST(TaxelCurvesFit, IgnoreWhatABagMasks) {
  test_support::SyntheticRig rig;
  DiscrepancyProblem problem = problemOf(rig);
  dataset::Recording broken = problem.recordings[0];
  broken.name = "broken.bag";
  broken.sha256 = "another";
  broken.start_ns += 10000000000000;
  broken.mask.assign(6, false);
  broken.mask[2] = true;
  for (std::size_t i = 0; i < broken.scans(); ++i) broken.counts[i * 6 + 2] = 4000;
  problem.recordings.push_back(broken);
  EXPECT_NEAR(gapOf(problem, curved(problem)), 0.00141, 0.0004);
}

}  // namespace
}  // namespace fsr::discrepancy
