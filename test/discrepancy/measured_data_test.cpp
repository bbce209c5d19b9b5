// Recordings of real sensors, not simulated; see test/data/README.md for their authors.
#include <gtest/gtest.h>

#include <algorithm>

#include "dataset/table_recording.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "simulation/driven_rig.h"

namespace fsr::discrepancy {
namespace {

DiscrepancyReport verdictOn(const std::string& table, const std::string& columns, dataset::TablePlan plan) {
  plan.columns = dataset::parseColumns(columns);
  plan.curvature = 0;
  DiscrepancyProblem problem;
  problem.recordings = {dataset::readTable(FSR_SOURCE_DIR "/test/data/measured/" + table, plan).recording};
  problem.simulation = simulation::fitted(
      simulation::readSimulationFile(FSR_SOURCE_DIR "/config/simulation/core.yaml"), problem.recordings[0]);
  return investigate(problem);
}

bool holds(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

bool anywhere(const DiscrepancyReport& report, const std::string& id) {
  return std::any_of(report.credible_set.begin(), report.credible_set.end(),
                     [&](const auto& ids) { return holds(ids, id); });
}

// Force of a piston against its position. The force is counted against the forward stroke, because the
// reading of a sheet is higher on the way back. The friction reverses within 5 mm of a stroke of 41 mm.
DiscrepancyReport piston(const std::string& table) {
  dataset::TablePlan plan;
  plan.range = {{10, 0}};
  return verdictOn(table, "time=1:ms,reading=4:V,reference=5:10000Pa", plan);
}

void expectALoop(const DiscrepancyReport& report) {
  ASSERT_FALSE(report.credible_set.empty()) << report.sentence;
  EXPECT_EQ(report.credible_set.front(), std::vector<std::string>{"hysteresis"}) << report.sentence;
  EXPECT_FALSE(anywhere(report, "drift")) << report.sentence;
  EXPECT_GT(report.gap.before, 3 * report.gap.after);
}

TEST(MeasuredPiston, IsALoopThatDoesNotDriftAt3Bar) {
  expectALoop(piston("piston_o_ring_3bar.txt.gz"));
}

TEST(MeasuredPiston, IsALoopThatDoesNotDriftAt7Bar) {
  expectALoop(piston("piston_o_ring_7bar.txt.gz"));
}

DiscrepancyReport chambers(const std::string& table, double area) {
  dataset::TablePlan plan;
  plan.area = area;
  return verdictOn(
      table, "time=time_s,reading=pressure_left_V:V,reading=pressure_right_V:V,reference=force_N:N", plan);
}

TEST(MeasuredFluid, AirLeaksSlowlyAndWithoutAThermometerIsNeverOnlyDrift) {
  const DiscrepancyReport report = chambers("fluid_air_4hz.csv.gz", 2e-5);
  ASSERT_FALSE(report.credible_set.empty()) << report.sentence;
  EXPECT_EQ(report.verdict, Verdict::kAmbiguous) << report.sentence;
  EXPECT_TRUE(anywhere(report, "drift")) << report.sentence;
  EXPECT_FALSE(holds(report.credible_set.front(), "hysteresis")) << report.sentence;
}

TEST(MeasuredFluid, OilLagsBesidesSomethingSlow) {
  const DiscrepancyReport report = chambers("fluid_oil_20min.csv.gz", 5e-6);
  ASSERT_FALSE(report.credible_set.empty()) << report.sentence;
  EXPECT_TRUE(anywhere(report, "time_skew") || anywhere(report, "creep")) << report.sentence;
  EXPECT_EQ(report.credible_set.front().size(), 2u) << report.sentence;
  EXPECT_LT(report.gap.after, 0.8 * report.gap.before);
}

}  // namespace
}  // namespace fsr::discrepancy
