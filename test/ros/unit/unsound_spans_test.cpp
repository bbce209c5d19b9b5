// Scans that are not the sheet under the recorded pressure, as the tools meet them in a bag.
#include <fsr_pressure_map/Event.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "ros/bags/bag_writer.h"
#include "ros/tools/tools.h"
#include "simulation/settings_text.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/source_dir.h"
#include "support/synthetic_recording.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class UnsoundSpans : public test_support::FolderTest {
 protected:
  void SetUp() override {
    ::setenv("ROS_HOME", folder_.c_str(), 1);
    test_support::SyntheticRig rig;  // cycles of 10 s, 100 scans each
    rig.surfaces = {{"flat", 0.0}, {"cylinder_13cm", 7.7}, {"cylinder_5cm", 20.0}};
    recording_ = test_support::syntheticRecording(rig);
    recording_.start_ns = 1500000000000000000;
  }

  // No taxel reads anything from scan `first` to `last`.
  void takeTheSheetOff(std::size_t first, std::size_t last) {
    const auto taxels = static_cast<std::ptrdiff_t>(recording_.layout.size.taxels());
    std::fill(recording_.counts.begin() + static_cast<std::ptrdiff_t>(first) * taxels,
              recording_.counts.begin() + static_cast<std::ptrdiff_t>(last + 1) * taxels, 0);
  }
  void expectThatEveryToolSays(const std::string& sentence, const std::string& bag) const {
    std::ofstream(path("plan.yaml"))
        << "study: quick\nforest: {trees: 5}\nresamples: 99\nbandwidths: [0.0078125, 0.0625]\n";
    fsr::simulation::SimulationSettings settings =
        fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/core.yaml");
    settings.layout = recording_.layout;
    std::ofstream(path("small.yaml")) << fsr::simulation::simulationText(settings);
    const std::vector<std::pair<decltype(&checkBagTool), std::vector<std::string>>> calls = {
        {checkBagTool, {"check_bag", bag}},
        {trainTool, {"train", bag, "--output", path("calibration.h5")}},
        {studyTool, {"study", bag, "--plan", path("plan.yaml"), "--output", path("study")}},
        {discrepancyTool,
         {"discrepancy", bag, "--simulation", path("small.yaml"), "--output", path("gap"), "--no-report"}}};
    for (const auto& [tool, words] : calls) {
      const test_support::ToolRun run =
          test_support::runTool(tool, words[0], {words.begin() + 1, words.end()});
      EXPECT_EQ(run.status, 0);
      EXPECT_TRUE(test_support::holds(run.printed, {sentence})) << words[0];
    }
  }

  fsr::dataset::Recording recording_;
};

TEST_F(UnsoundSpans, OfARejectedAttemptAreLeftOutByEveryToolAndNamed) {
  takeTheSheetOff(230, 280);
  const std::string bag = path("day.bag");
  writeBag(bag, recording_);
  {
    rosbag::Bag more(bag, rosbag::bagmode::Append);
    const auto tell = [&](const std::string& kind, const std::string& label, std::int64_t scan) {
      fsr_pressure_map::Event event;
      event.header.stamp.fromNSec(
          static_cast<std::uint64_t>(recording_.start_ns + 100'000'000 * scan + 1'000'000));
      event.kind = kind;
      event.label = label;
      more.write("/fsr/events", event.header.stamp, event);
    };
    tell("step", "cycle 1 of 5 on flat, mount 1 accepted", 100);
    tell("reject", "cycle 2 of 5 on flat, mount 1 rejected (peak_missed): the pressure turned", 180);
    tell("reject", "cycle 2 of 5 on flat, mount 1 rejected (sheet_off): no taxel answers", 233);
    tell("step", "cycle 2 of 5 on flat, mount 1 accepted", 400);
  }
  const fsr::dataset::Recording read = readBag(bag);
  EXPECT_EQ(read.scans() + 99 + read.losses.near_change, recording_.scans());  // from rest to rest
  EXPECT_NEAR(read.time[201] - read.time[200], 10, 1e-6);
  expectThatEveryToolSays(
      "left out 99 scans that are not the sheet under the recorded pressure: 20.1 to 29.9 s (attempt "
      "rejected: sheet_off)",
      bag);
}

TEST_F(UnsoundSpans, WithoutAnyEventAreFoundByEveryTool) {
  takeTheSheetOff(220, 260);
  std::fill(recording_.pressure.begin() + 732, recording_.pressure.begin() + 762, 0.0);
  const std::string bag = path("day.bag");
  writeBag(bag, recording_);
  expectThatEveryToolSays(
      "left out 72 scans that are not the sheet under the recorded pressure: 22.0 to 26.1 s (pressure "
      "without reading), 73.2 to 76.1 s (reading without pressure)",
      bag);
}

}  // namespace
}  // namespace fsr_ros
