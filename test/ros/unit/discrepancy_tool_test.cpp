#include "fsr_pressure_map/ros/discrepancy_tool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fsr_pressure_map/report/verdict_file.h"
#include "fsr_pressure_map/ros/bag_writer.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/simulation_text.h"
#include "support/synthetic_recording.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

const std::string kCore = FSR_SOURCE_DIR "/config/simulation/core.yaml";

// Refusals, and what lies in the folder afterwards; the verdicts themselves are tested in test/discrepancy.
class DiscrepancyTool : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("tool_" + std::to_string(::getpid()) +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "session");
    ::setenv("ROS_HOME", folder_.c_str(), 1);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static fsr::Recording recorded(const test_support::SyntheticRig& rig) {
    fsr::Recording recording = test_support::syntheticRecording(rig);
    recording.start_ns = 1500000000000000000;
    return recording;
  }
  static fsr::Recording recording(const std::string& surface, double curvature) {
    test_support::SyntheticRig rig;
    rig.surfaces = {{surface, curvature}};
    return recorded(rig);
  }
  std::string bag(const std::string& name, const fsr::Recording& recording) const {
    writeBag(path(name), recording);
    return path(name);
  }
  /// A simulation of the synthetic rig's matrix.
  std::string simulation() const {
    fsr::SimulationSettings settings = fsr::readSimulationFile(kCore);
    settings.layout = recording("flat", 0).layout;
    std::ofstream(path("small.yaml")) << fsr::simulationText(settings);
    return path("small.yaml");
  }
  /// What it says: its words, or the complaint.
  std::string run(std::vector<std::string> words) {
    words.insert(words.begin(), "discrepancy");
    std::vector<const char*> arguments;
    for (const std::string& word : words) arguments.push_back(word.c_str());
    std::ostringstream out;
    try {
      EXPECT_EQ(discrepancyTool(static_cast<int>(arguments.size()), arguments.data(), out), 0);
      return out.str();
    } catch (const fsr::InputError& error) {
      return error.what();
    }
  }
  void expectSaid(const std::string& said, const std::vector<std::string>& parts) const {
    for (const std::string& part : parts)
      EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
  }

  fs::path folder_;
};

TEST_F(DiscrepancyTool, TakesAFolderAndCountsEveryLook) {
  bag("session/1_flat.bag", recording("flat", 0));
  bag("session/2_bend.bag", recording("bend", 14.25));
  const std::vector<std::string> words = {path("session"), "--simulation", simulation(),         "--output",
                                          path("out"),     "--no-report",  "__name:=discrepancy"};
  expectSaid(run(words), {"Gap, rms", "Written: " + path("out/verdict.yaml")});
  const fsr::VerdictFile first = fsr::readVerdict(path("out/verdict.yaml"));
  ASSERT_EQ(first.inputs.size(), 2u);
  EXPECT_EQ(first.inputs[0].file, "1_flat.bag");
  EXPECT_EQ(first.inputs[0].sha256.size(), 64u);
  EXPECT_EQ(first.inputs[1].show_opened, 1);
  run(words);
  EXPECT_EQ(fsr::readVerdict(path("out/verdict.yaml")).inputs[1].show_opened, 2);
  for (const char* file : {"simulation.yaml", "base.yaml", "prediction.yaml", "results.json"})
    EXPECT_TRUE(fs::exists(folder_ / "out" / file)) << file;
}

TEST_F(DiscrepancyTool, RefusesWithOneSentenceAndLeavesNoVerdict) {
  const std::string flat = bag("flat.bag", recording("flat", 0));
  fsr::Recording silent = recording("flat", 0);
  silent.pressure.clear();
  const std::string no_pressure = bag("silent.bag", silent);
  std::ofstream(path("text.bag")) << "no bag";
  const auto tried = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"--simulation", simulation(), "--output", path("out"), "--no-report"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  expectSaid(tried({}), {"no BAG"});
  expectSaid(tried({path("none.bag")}), {"none.bag"});
  expectSaid(tried({path("text.bag")}), {"text.bag"});
  expectSaid(tried({path("session")}), {"session", "no file that ends with .bag"});
  expectSaid(tried({no_pressure}), {"silent.bag", "chamber pressure"});
  expectSaid(tried({flat, "--ask", "magic"}), {"--ask", "magic"});
  expectSaid(tried({flat, "--without", "magic"}), {"--without", "magic"});
  expectSaid(tried({flat, "--seed", "-1"}), {"--seed"});
  expectSaid(run({flat, "--simulation", kCore, "--output", path("out")}),
             {"core.yaml", "7 x 10", "flat.bag"});
  expectSaid(run({flat}), {"--output"});
  EXPECT_FALSE(fs::exists(folder_ / "out" / "verdict.yaml"));
}

TEST_F(DiscrepancyTool, ConfirmsByBagsThatAreNewWhatItPredicted) {
  test_support::SyntheticRig rig;
  rig.cycles = 12;
  const std::string nothing = bag("nothing.bag", recorded(rig));
  run({nothing, "--simulation", simulation(), "--output", path("none"), "--no-report"});
  expectSaid(run({"--confirm", path("nowhere.yaml"), nothing}), {"nowhere.yaml", "cannot be opened"});
  expectSaid(run({"--confirm", path("none/verdict.yaml"), nothing}), {"verdict is none", "predicts nothing"});
  rig.loop = 200;
  const std::string loop = bag("loop.bag", recorded(rig));
  run({loop, "--simulation", simulation(), "--output", path("out"), "--no-report"});
  const fsr::VerdictFile verdict = fsr::readVerdict(path("out/verdict.yaml"));
  ASSERT_FALSE(verdict.effects.empty()) << verdict.verdict;
  expectSaid(run({"--confirm", path("out/verdict.yaml"), loop}), {"loop.bag", "made from this bag"});
  rig.seed = 2;
  const std::string again = bag("again.bag", recorded(rig));
  expectSaid(run({"--confirm", path("out/verdict.yaml"), again}), {"Confirmed: "});
  EXPECT_TRUE(fs::exists(folder_ / "out" / "confirmation.yaml"));
  rig.loop = 0;
  const std::string without = bag("without.bag", recorded(rig));
  expectSaid(run({"--confirm", path("out/verdict.yaml"), without}), {"Not confirmed: "});
}

}  // namespace
}  // namespace fsr_ros
