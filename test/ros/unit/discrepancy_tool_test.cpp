#include "ros/tools/tools.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "discrepancy/planted.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/verdict_file.h"
#include "ros/bags/bag_writer.h"
#include "simulation/settings_text.h"
#include "support/content_of.h"
#include "support/folder_test.h"
#include "support/source_dir.h"
#include "support/synthetic_recording.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

const std::string kCore = test_support::sourceDir() + "/config/simulation/core.yaml";

// Errors of the tool and the files that it leaves; the verdicts are tested in test/discrepancy.
class DiscrepancyTool : public test_support::FolderTest {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "session");
    ::setenv("ROS_HOME", folder_.c_str(), 1);
  }

  static fsr::dataset::Recording recorded(const test_support::SyntheticRig& rig) {
    fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
    recording.start_ns = 1500000000000000000;
    return recording;
  }
  static fsr::dataset::Recording recording(const std::string& surface, double curvature) {
    test_support::SyntheticRig rig;
    rig.surfaces = {{surface, curvature}};
    return recorded(rig);
  }
  std::string bag(const std::string& name, const fsr::dataset::Recording& recording) const {
    writeBag(path(name), recording);
    return path(name);
  }
  /// A simulation of the synthetic rig's matrix.
  std::string simulation() const {
    fsr::simulation::SimulationSettings settings = fsr::simulation::readSimulationFile(kCore);
    settings.layout = recording("flat", 0).layout;
    std::ofstream(path("small.yaml")) << fsr::simulation::simulationText(settings);
    return path("small.yaml");
  }
  /// The output of the tool, or its error.
  std::string run(const std::vector<std::string>& words) {
    const test_support::ToolRun run = test_support::runTool(discrepancyTool, "discrepancy", words);
    EXPECT_EQ(run.status, run.error.empty() ? 0 : -1);
    EXPECT_EQ(run.said().find("nan"), std::string::npos) << run.said();
    return run.said();
  }
  void expectSaid(const std::string& said, const std::vector<std::string>& parts) const {
    for (const std::string& part : parts)
      EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
  }
};

TEST_F(DiscrepancyTool, TakesAFolderAndCountsEveryUse) {
  bag("session/1_flat.bag", recording("flat", 0));
  bag("session/2_bend.bag", recording("bend", 14.25));
  const std::vector<std::string> words = {path("session"), "--simulation", simulation(),         "--output",
                                          path("out"),     "--no-report",  "__name:=discrepancy"};
  expectSaid(run(words),
             {"Gap, rms", "Written: " + path("out/verdict.yaml"), "All is done. roslaunch now ends"});
  const fsr::report::VerdictFile first = fsr::report::readVerdict(path("out/verdict.yaml"));
  ASSERT_EQ(first.inputs.size(), 2u);
  EXPECT_EQ(first.inputs[0].file, "1_flat.bag");
  EXPECT_EQ(first.inputs[0].sha256.size(), 64u);
  EXPECT_EQ(first.inputs[1].hold_out_opened, 1);
  run(words);
  EXPECT_EQ(fsr::report::readVerdict(path("out/verdict.yaml")).inputs[1].hold_out_opened, 2);
  for (const char* file : {"simulation.yaml", "base.yaml", "prediction.yaml", "results.json"})
    EXPECT_TRUE(fs::exists(folder_ / "out" / file)) << file;
}

// The files may go to other people, so they name bags and folders, but not where these lie.
TEST_F(DiscrepancyTool, WritesNoAbsolutePathAndRecomputesTheGapFromAFolder) {
  bag("session/1_flat.bag", recording("flat", 0));
  bag("session/2_bend.bag", recording("bend", 14.25));
  bag("session/3_other.bag", recording("other", 20));
  const std::string said = run({path("session/1_flat.bag"), path("session/2_bend.bag"), "--simulation",
                                simulation(), "--output", path("out/")});
  expectSaid(said, {"simulate --gap " + path("out/verdict.yaml") + " --drive " + path("session/1_flat.bag")});
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) {
    if (!entry.is_regular_file()) continue;
    const std::string text = test_support::contentOf(entry.path());
    EXPECT_EQ(text.find(folder_.parent_path().string()), std::string::npos) << entry.path();
    if (entry.path().filename() == "verdict.yaml")
      expectSaid(text, {"simulate --gap out/verdict.yaml --drive 1_flat.bag 2_bend.bag"});
  }
  EXPECT_TRUE(fs::exists(folder_ / "out" / "report.html"));
  const std::string verdict = path("out/verdict.yaml"), session = path("session");
  const char* const words[] = {"simulate", "--gap", verdict.c_str(), "--drive", session.c_str()};
  std::ostringstream out;
  EXPECT_EQ(simulateTool(5, words, out), 0);
  expectSaid(out.str(), {"Gap of base.yaml: ", "Gap of simulation.yaml: "});
}

TEST_F(DiscrepancyTool, RefusesWithOneSentenceAndLeavesNoVerdict) {
  const std::string flat = bag("flat.bag", recording("flat", 0));
  fsr::dataset::Recording silent = recording("flat", 0);
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

// Each gives an error in one sentence, and none leaves a verdict.
TEST_F(DiscrepancyTool, RefusesRecordingsThatCannotGiveAVerdict) {
  const auto tried = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"--output", path("out"), "--no-report"};
    words.insert(words.end(), more.begin(), more.end());
    const std::string said = run(words);
    EXPECT_FALSE(fs::exists(folder_ / "out" / "verdict.yaml")) << said;
    fs::remove_all(folder_ / "out");
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    return said;
  };
  const fsr::dataset::Recording good = recording("flat", 0);
  const std::string flat = bag("flat.bag", good);
  expectSaid(tried({flat, flat}), {"flat.bag: holds the same scans as flat.bag; give every bag once"});
  fs::copy_file(flat, path("copy.bag"));
  expectSaid(tried({flat, path("copy.bag")}), {"copy.bag: holds the same scans as flat.bag"});

  test_support::SyntheticRig other_rig;
  other_rig.size = {3, 4};
  expectSaid(tried({flat, bag("other.bag", recorded(other_rig))}),
             {"other.bag: is of a matrix of 3 x 4", "flat.bag of 2 x 3", "bags of one sheet"});

  test_support::SyntheticRig once;
  once.cycles = 1;
  expectSaid(tried({bag("once.bag", recorded(once))}), {"once.bag: 1 cycle of", "at least 3 are needed"});

  fsr::dataset::Recording low = good;
  for (double& pressure : low.pressure) pressure *= 0.005;
  expectSaid(tried({bag("low.bag", low)}), {"low.bag: chamber pressure covers", "at least 10 kPa"});

  fsr::dataset::Recording dead = good;
  for (std::size_t k = 0; k < dead.counts.size(); ++k) {
    if (k % 6 < 4) dead.counts[k] = 0;
  }
  expectSaid(tried({bag("dead.bag", dead)}), {"dead.bag: 4 of 6 taxels", "at least half must be usable"});

  fs::resize_file(path("copy.bag"), fs::file_size(flat) / 2);
  expectSaid(tried({path("copy.bag")}), {"copy.bag: is not a complete bag", "close_bag"});
  std::ofstream(path("empty.bag"));
  expectSaid(tried({path("empty.bag")}), {"empty.bag: the file is empty"});
  std::ofstream(path("file")) << "x";
  expectSaid(run({flat, "--output", path("file")}), {"file: the folder cannot be created"});
  expectSaid(run({flat, "--output", path("file/under")}), {"the folder cannot be created"});
}

// If a clock is set back during the recording, later scans get earlier stamps.
TEST_F(DiscrepancyTool, RefusesStampsThatRunBackwards) {
  fsr::dataset::Recording set_back = recording("flat", 0);
  for (std::size_t i = 250; i < set_back.scans(); ++i) set_back.time[i] -= 10.05;
  expectSaid(run({bag("back.bag", set_back), "--output", path("out"), "--no-report"}),
             {"back.bag: its stamps run backwards", "was a clock set"});
  EXPECT_FALSE(fs::exists(folder_ / "out" / "verdict.yaml"));
}

TEST_F(DiscrepancyTool, StatesWhatARecordingLacks) {
  fsr::dataset::Recording swapped = recording("flat", 0);
  std::swap(swapped.time[100], swapped.time[110]);
  const std::string said = run({bag("swapped.bag", swapped), "--output", path("out"), "--no-report"});
  expectSaid(said, {"Limitation: swapped.bag: the board's counter ran backwards 2 times",
                    "No temperature was recorded"});
}

// As a user does: bags in, verdict.yaml out, and bags of a later day to confirm it.
class PlantedSession : public DiscrepancyTool {
 protected:
  /// Bags of a session, one for each surface.
  std::vector<std::string> session(const std::string& name, const std::string& rig, std::uint64_t seed,
                                   const std::string& hidden) const {
    fsr::simulation::SimulationSettings settings = fsr::discrepancy::planted::simulation(rig, hidden);
    settings.seed = seed;
    std::vector<std::string> bags;
    for (const fsr::dataset::Recording& one : fsr::simulation::simulateSession(settings))
      bags.push_back(bag(name + std::to_string(bags.size()) + ".bag", one));
    return bags;
  }
  std::string with(std::vector<std::string> words, const std::vector<std::string>& bags) {
    words.insert(words.end(), bags.begin(), bags.end());
    return run(words);
  }
};

TEST_F(PlantedSession, OptionsGoToTheSearchAndAnswersIntoTheVerdict) {
  with({"--output", path("out"), "--no-report", "--without", "time_skew", "--ask", "crosstalk"},
       session("late", fsr::discrepancy::planted::kTwoSpeeds, 7, "  time_skew: {delay: 0.3}\n"));
  const fsr::report::VerdictFile file = fsr::report::readVerdict(path("out/verdict.yaml"));
  EXPECT_EQ(file.verdict, "unknown");
  EXPECT_TRUE(file.effects.empty());
  expectSaid(test_support::contentOf(folder_ / "out/verdict.yaml"),
             {"{id: crosstalk, answer: not_identifiable"});
}

// A single speed cannot distinguish a loop from a short memory. Bags of two speeds confirm the right one.
TEST_F(PlantedSession, IsConfirmedByBagsThatAreNew) {
  using fsr::discrepancy::planted::kOneSpeed;
  using fsr::discrepancy::planted::kTwoSpeeds;
  const std::string loop = "  hysteresis: {loop_width: 0.05}\n";
  const std::vector<std::string> nothing = session("nothing", kOneSpeed, 7, "");
  with({"--output", path("none"), "--no-report"}, nothing);
  expectSaid(with({"--confirm", path("nowhere.yaml")}, nothing), {"nowhere.yaml", "there is no such file"});
  expectSaid(with({"--confirm", path("none/verdict.yaml")}, nothing),
             {"verdict is none", "predicts nothing"});
  const std::vector<std::string> first = session("loop", kOneSpeed, 7, loop);
  with({"--output", path("out"), "--no-report"}, first);
  const fsr::report::VerdictFile file = fsr::report::readVerdict(path("out/verdict.yaml"));
  ASSERT_EQ(file.verdict, "ambiguous");
  EXPECT_EQ(file.credible_set.front(), std::vector<std::string>{"hysteresis"});
  EXPECT_GE(file.credible_set.size(), 2u);
  expectSaid(with({"--confirm", path("out/verdict.yaml")}, first), {"loop0.bag", "made from this bag"});
  std::vector<std::string> copies;  // written anew, with other stamps of reception
  for (const std::string& one : first) {
    fsr::dataset::Recording copy = readBag(one);
    copy.start_ns += 86'400'000'000'000;
    copies.push_back(bag("copy" + std::to_string(copies.size()) + ".bag", copy));
  }
  expectSaid(with({"--confirm", path("out/verdict.yaml")}, copies),
             {"copy0.bag", "made from a bag with the same readings"});
  expectSaid(with({"--confirm", path("out/verdict.yaml")}, session("again", kOneSpeed, 8, loop)),
             {"Confirmed: ", "Same protocol: proves little", "Written: " + path("out/confirmation.yaml")});
  const std::string said =
      with({"--confirm", path("out/verdict.yaml")}, session("speeds", kTwoSpeeds, 8, loop));
  EXPECT_EQ(said.find("Confirmed: hysteresis"), 0u) << said;
  EXPECT_EQ(said.find("ame protocol"), std::string::npos) << said;
  expectSaid(with({"--confirm", path("out/verdict.yaml")},
                  session("memory", kTwoSpeeds, 9, "  creep: {per_decade: 0.05, slowest: 100}\n")),
             {"Not confirmed: ", "Written: " + path("out/confirmation_3.yaml")});
  for (const auto& [name, passed] :
       {std::pair{"confirmation.yaml", "passed: true"}, std::pair{"confirmation_3.yaml", "passed: false"}}) {
    expectSaid(test_support::contentOf(folder_ / "out" / name), {passed});
  }
}

}  // namespace
}  // namespace fsr_ros
