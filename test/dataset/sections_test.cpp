#include "dataset/sections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "support/holds.h"
#include "support/synthetic_recording.h"

namespace fsr::dataset {
namespace {

using test_support::syntheticRecording;
using test_support::SyntheticRig;

std::vector<double> triangles(std::size_t cycles, std::size_t readings, double peak) {
  std::vector<double> pressure;
  for (std::size_t i = 0; i < cycles * readings; ++i) {
    pressure.push_back(
        test_support::trianglePressure(static_cast<double>(i) / static_cast<double>(readings), peak));
  }
  return pressure;
}

TEST(Cycles, AreCutAtTheValleys) {
  const Cycles cycles = findCycles(triangles(3, 100, 600e3));
  EXPECT_EQ(cycles.first, (std::vector<std::size_t>{0, 100, 200}));
  EXPECT_EQ(cycles.direction[50], statistics::LoadDirection::kLoading);
  EXPECT_EQ(cycles.direction[51], statistics::LoadDirection::kUnloading);
  EXPECT_EQ(cycles.direction[100], statistics::LoadDirection::kUnloading);
  EXPECT_EQ(cycles.direction[101], statistics::LoadDirection::kLoading);
}

TEST(Cycles, IgnoreNoiseAndStepsWithinACycle) {
  std::mt19937 random(3);
  std::vector<double> pressure = triangles(4, 400, 600e3);
  for (double& value : pressure) {
    value = std::floor(value / 60e3) * 60e3 + static_cast<double>(random() % 10000);  // steps, 10 kPa noise
  }
  EXPECT_EQ(findCycles(pressure).count(), 4u);
}

TEST(Cycles, CountEachOfIncreasingPeaks) {
  std::vector<double> pressure;
  for (const double peak : {60e3, 150e3, 300e3, 600e3}) {
    const auto one = triangles(1, 100, peak);
    pressure.insert(pressure.end(), one.begin(), one.end());
  }
  EXPECT_EQ(findCycles(pressure).count(), 4u);
}

// Bits that flip in the reference: single readings beside the course, also two with one good reading between.
TEST(Cycles, IgnoreSpikes) {
  std::vector<double> pressure = triangles(4, 400, 600e3);
  for (const std::size_t at : {37u, 250u, 252u, 611u, 900u}) pressure[at] += 40e3;
  pressure[1210] -= 40e3;
  EXPECT_EQ(findCycles(pressure).count(), 4u);
  EXPECT_EQ(findCycles(pressure).first, findCycles(triangles(4, 400, 600e3)).first);
  pressure[500] = 6e6;
  EXPECT_EQ(findCycles(pressure).count(), 4u) << "a spike that widens the range";
}

TEST(Cycles, OfFewReadingsHaveNoSpikes) {
  const std::vector<double> pressure = triangles(5, 6, 600e3);
  EXPECT_EQ(findCycles(pressure).count(), 5u);
}

TEST(Cycles, AreNoneForAConstantPressure) {
  std::vector<double> pressure(100, 5e3);
  pressure[50] += 1e3;  // noise
  const Cycles cycles = findCycles(pressure);
  EXPECT_EQ(cycles.count(), 0u);
  EXPECT_EQ(cycles.direction.at(99), statistics::LoadDirection::kNone);
  EXPECT_EQ(findCycles({}).count(), 0u);
  EXPECT_EQ(findCycles({1.0}).count(), 0u);
}

TEST(Cycles, IncludeASingleRiseOrFall) {
  const Cycles rise = findCycles({0, 100e3, 200e3, 300e3});
  EXPECT_EQ(rise.count(), 1u);
  EXPECT_EQ(rise.direction.at(3), statistics::LoadDirection::kLoading);
  const Cycles fall = findCycles({300e3, 200e3, 100e3, 0});
  EXPECT_EQ(fall.count(), 1u);
  EXPECT_EQ(fall.direction.at(3), statistics::LoadDirection::kUnloading);
}

// Sections of one condition in order of its scans, without repetitions.
std::vector<std::uint32_t> sequenceOf(const Recording& recording, const Sections& sections,
                                      std::uint32_t condition) {
  std::vector<std::uint32_t> sequence;
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (recording.condition[i] != condition) continue;
    if (sequence.empty() || sequence.back() != sections.section[i]) sequence.push_back(sections.section[i]);
  }
  return sequence;
}

TEST(Sections, AreContiguousInEachConditionAndNeverSplitACycle) {
  SyntheticRig rig;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_5cm", 20.0}};
  rig.cycles = 7;
  const Recording recording = syntheticRecording(rig);
  const Sections sections = divideIntoSections(recording, 5);
  EXPECT_EQ(sections.cycles, (std::vector<std::size_t>{7, 7}));
  EXPECT_EQ(sequenceOf(recording, sections, 0), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(sequenceOf(recording, sections, 1), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;  // of cycle and section
  for (std::size_t i = 0; i < 700; ++i) pairs.emplace(sections.cycle[i], sections.section[i]);
  EXPECT_EQ(pairs.size(), 7u);
  EXPECT_TRUE(sections.warnings.empty());
}

TEST(Sections, DivideByTimeWithAWarningWhereCyclesAreFew) {
  SyntheticRig rig;
  rig.cycles = 3;
  const Recording recording = syntheticRecording(rig);
  const Sections sections = divideIntoSections(recording, 5);
  EXPECT_EQ(sequenceOf(recording, sections, 0), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  ASSERT_EQ(sections.warnings.size(), 1u);
  EXPECT_TRUE(test_support::holds(sections.warnings.front(),
                                  {"synthetic.bag, \"flat\"", "3 cycles", "5 sections", "by time instead"}));
}

TEST(Sections, DivideAConstantPressureByTimeWithAWarning) {
  Recording recording = syntheticRecording({});
  for (double& pressure : recording.pressure) pressure = 3e3;
  const Sections sections = divideIntoSections(recording, 5);
  EXPECT_EQ(sequenceOf(recording, sections, 0), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(test_support::holds(sections.warnings.at(0), {"synthetic.bag, \"flat\"", "never changes"}));
}

TEST(Sections, ExcludeAScanWithoutPressure) {
  Recording recording = syntheticRecording({});
  recording.pressure[42] = std::nan("");
  const Sections sections = divideIntoSections(recording, 5);
  EXPECT_EQ(sections.section[42], kNoSection);
  EXPECT_NE(sections.section[43], kNoSection);
}

TEST(Sections, AreEmptyWhereScansAreFewer) {
  SyntheticRig rig;
  rig.cycles = 1;
  rig.scans_per_cycle = 2;
  const Sections sections = divideIntoSections(syntheticRecording(rig), 5);
  EXPECT_EQ(sections.section, (std::vector<std::uint32_t>{0, 2}));
}

}  // namespace
}  // namespace fsr::dataset
