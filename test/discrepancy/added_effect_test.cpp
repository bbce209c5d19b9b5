// An effect from outside the package is a candidate of the discrepancy without any change to the package.

#include <gtest/gtest.h>

#include "planted.h"
#include "simulation/settings_text.h"
#include "support/dummy_effect.h"

namespace fsr::discrepancy {
namespace {

simulation::SimulationSettings rig(const std::string& more) {
  return simulation::readSimulation(settings::Settings::fromText(planted::kTwoSpeeds + more, "rig.yaml"),
                                    test_support::libraryWithRateGain());
}

TEST(AddedEffect, IsACandidate) {
  DiscrepancyProblem problem;
  problem.simulation = rig("");
  problem.recordings = simulation::simulateSession(rig("  rate_gain: {change: 0.08}\n"));
  problem.options.threads = 1;
  const DiscrepancyReport report = investigate(problem);
  EXPECT_EQ(std::count(report.tested.begin(), report.tested.end(), "rate_gain"), 1);
  ASSERT_FALSE(report.candidates.empty());
  EXPECT_EQ(report.candidates.front().ids, std::vector<std::string>{"rate_gain"}) << report.sentence;
  EXPECT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
}

}  // namespace
}  // namespace fsr::discrepancy
