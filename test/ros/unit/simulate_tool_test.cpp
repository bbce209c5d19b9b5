#include "ros/tools/tools.h"

#include <fsr_pressure_map/MatrixFrame.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "ros/bags/bag_writer.h"
#include "ros/bags/simulated_bags.h"
#include "settings/sha256.h"
#include "simulation/portrait.h"
#include "simulation/pressure_profile.h"
#include "simulation/session.h"
#include "simulation/settings_text.h"
#include "support/content_of.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/source_dir.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

const std::string kBench = test_support::sourceDir() + "/config/simulation/bench.yaml";

class SimulateTool : public test_support::FolderTest {
 protected:
  std::string run(const std::vector<std::string>& words) {
    run_ = test_support::runTool(simulateTool, "simulate", words);
    return run_.said();
  }

  test_support::ToolRun run_;
};

std::set<std::string> topicsOf(const std::string& bag_path) {
  const rosbag::Bag bag(bag_path, rosbag::bagmode::Read);
  rosbag::View view(bag);
  std::set<std::string> topics;
  for (const auto* connection : view.getConnections()) topics.insert(connection->topic);
  return topics;
}

std::set<std::string> filesIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& file : fs::directory_iterator(folder)) names.insert(file.path().filename());
  return names;
}

TEST_F(SimulateTool, WritesABagForEachStationAndTheTruthBeside) {
  const std::string printed = run({"--simulation", kBench, "--output", path("out")});
  EXPECT_EQ(run_.status, 0);
  EXPECT_EQ(filesIn(path("out")), (std::set<std::string>{"1_flat.bag", "2_cylinder_5cm.bag", "truth.yaml"}));
  EXPECT_NE(printed.find(path("out/1_flat.bag")), std::string::npos);
  const auto truth = fsr::simulation::readSimulationFile(path("out/truth.yaml"));
  const auto bench = fsr::simulation::readSimulationFile(kBench);
  EXPECT_EQ(simulationText(truth), simulationText(bench));
}

TEST_F(SimulateTool, RunsTheSurfacesAndTheProgramOfAPlan) {
  const std::string plan = test_support::sourceDir() + "/config/sessions/field_check.yaml";
  run({"--simulation", kBench, "--plan", plan, "--output", path("out")});
  EXPECT_EQ(filesIn(path("out")), (std::set<std::string>{"1_flat.bag", "2_flat.bag", "truth.yaml"}));
  const fsr::dataset::Recording second = readBag(path("out/2_flat.bag"));
  EXPECT_EQ(second.conditions.at(0).mount, 2u);
  EXPECT_NEAR(*std::max_element(second.pressure.begin(), second.pressure.end()), 620e3, 2e3);
  // Rest, two cycles to 310 kPa and three to 620 kPa with dwells of 1 s at 17 kPa/s, rest.
  EXPECT_NEAR(second.time.back(), 60 + 10 + (2 * 620 + 3 * 1240) / 17.0, 1);
  EXPECT_TRUE(test_support::holds(run({"--simulation", kBench, "--plan", plan, "--drive",
                                       path("out/1_flat.bag"), "--output", path("new")}),
                                  {"--plan and --drive"}));
}

TEST_F(SimulateTool, ItsBagsReadAsTheRigsRecordings) {
  run({"--simulation", kBench, "--output", path("out")});
  const auto expected = fsr::simulation::simulateSession(fsr::simulation::readSimulationFile(kBench));
  for (const fsr::dataset::Recording& recording : expected) {
    const fsr::dataset::Recording read = readBag(path("out/" + recording.name));
    EXPECT_EQ(read.counts, recording.counts);
    EXPECT_EQ(read.time, recording.time);
    EXPECT_EQ(read.start_ns, recording.start_ns);
    EXPECT_EQ(read.conditions.at(0).mount, recording.conditions.at(0).mount);
    EXPECT_EQ(read.sensor.serial, "SIM-0001");
    EXPECT_EQ(read.losses.lost_scans, 0u);
    EXPECT_TRUE(read.warnings.empty());
    ASSERT_EQ(read.pressure.size(), recording.pressure.size());
    for (std::size_t i = 0; i < read.pressure.size(); ++i) {
      EXPECT_NEAR(read.pressure[i], recording.pressure[i], 1e-6);
    }
    EXPECT_EQ(read.temperature, recording.temperature);
  }
}

TEST_F(SimulateTool, ItsBagsHoldWhatARecordedOneHolds) {
  run({"--simulation", kBench, "--output", path("out")});
  EXPECT_EQ(topicsOf(path("out/1_flat.bag")),
            (std::set<std::string>{"/fsr/raw", "/fsr/chamber_pressure", "/fsr/temperature",
                                   "/fsr/matrix_info", "/fsr/curvature", "/fsr/session"}));
  const rosbag::Bag bag(path("out/1_flat.bag"), rosbag::bagmode::Read);
  rosbag::View view(bag);
  ros::Time before;
  for (const rosbag::MessageInstance& instance : view) {
    EXPECT_GE(instance.getTime(), before);
    before = instance.getTime();
    const auto scan = instance.instantiate<fsr_pressure_map::MatrixFrame>();
    if (!scan) continue;
    EXPECT_EQ(scan->header.stamp, instance.getTime());
    EXPECT_EQ(scan->header.frame_id, "fsr_matrix");
    EXPECT_EQ(scan->header.seq, scan->sequence);
    EXPECT_EQ(scan->device_time, scan->sequence * 50000u);  // 20 Hz
  }
}

TEST_F(SimulateTool, ReplaysLatchWhatTheNodesLatch) {
  run({"--simulation", kBench, "--output", path("out")});
  const rosbag::Bag bag(path("out/1_flat.bag"), rosbag::bagmode::Read);
  rosbag::View view(bag);
  std::set<std::string> latched;
  for (const auto* connection : view.getConnections()) {
    if (connection->header->count("latching") > 0) latched.insert(connection->topic);
  }
  EXPECT_EQ(latched, (std::set<std::string>{"/fsr/matrix_info", "/fsr/curvature", "/fsr/session"}));
  EXPECT_EQ(view.getConnections().size(), 6u);
}

TEST_F(SimulateTool, GoesOnFromASavedState) {
  run({"--simulation", kBench, "--output", path("one"), "--save-state", path("state.yaml")});
  ASSERT_EQ(run_.status, 0);
  run({"--simulation", kBench, "--output", path("two"), "--state", path("state.yaml")});
  EXPECT_EQ(filesIn(path("two")), (std::set<std::string>{"3_flat.bag", "4_cylinder_5cm.bag", "truth.yaml"}));
  const fsr::dataset::Recording before = readBag(path("one/2_cylinder_5cm.bag")),
                                after = readBag(path("two/3_flat.bag"));
  EXPECT_GT(after.start_ns, before.start_ns + static_cast<std::int64_t>(1e9 * before.time.back()));
  EXPECT_NE(after.counts, readBag(path("one/1_flat.bag")).counts);
  run({"--simulation", kBench, "--output", path("model"), "--drive", path("two/3_flat.bag"), "--state",
       path("state.yaml")});
  EXPECT_EQ(run_.status, 0);
}

TEST_F(SimulateTool, DrivesTheModelWithRecordedBags) {
  run({"--simulation", kBench, "--output", path("real")});
  run({"--simulation", kBench, "--output", path("model"), "--drive", path("real/1_flat.bag"),
       path("real/2_cylinder_5cm.bag"), "--seed", "7"});
  EXPECT_EQ(run_.status, 0);
  for (const std::string name : {"1_flat.bag", "2_cylinder_5cm.bag"}) {
    const fsr::dataset::Recording real = readBag(path("real/" + name)),
                                  model = readBag(path("model/" + name));
    EXPECT_EQ(topicsOf(path("model/" + name)), topicsOf(path("real/" + name)));
    EXPECT_EQ(model.time, real.time);
    EXPECT_EQ(model.start_ns, real.start_ns);
    EXPECT_EQ(model.pressure, real.pressure);
    EXPECT_EQ(model.conditions.size(), real.conditions.size());
    EXPECT_NE(model.counts, real.counts);  // another sheet
  }
}

TEST_F(SimulateTool, TakesTheOneSensorThatItIsTold) {
  run({"--simulation", kBench, "--output", path("real")});
  {
    const rosbag::Bag one(path("real/1_flat.bag"), rosbag::bagmode::Read);
    rosbag::Bag two(path("two.bag"), rosbag::bagmode::Write);
    rosbag::View view(one);
    for (const rosbag::MessageInstance& instance : view) {
      const std::string name = instance.getTopic().substr(4);  // less "/fsr"
      two.write("/left" + name, instance.getTime(), instance);
      two.write("/right" + name, instance.getTime(), instance);
    }
  }
  run({"--simulation", kBench, "--output", path("model"), "--drive", path("two.bag"), "--namespace", "left"});
  ASSERT_EQ(run_.status, 0);
  for (const std::string& topic : topicsOf(path("model/two.bag"))) EXPECT_EQ(topic.find("/left/"), 0u);
  EXPECT_EQ(topicsOf(path("model/two.bag")).size(), 6u);
}

TEST_F(SimulateTool, LeavesNothingBehindWhereABagCannotDriveIt) {
  std::ofstream(path("text.bag")) << "no bag";
  const std::string said =
      run({"--simulation", kBench, "--output", path("new"), "--drive", path("text.bag")});
  EXPECT_NE(said.find("text.bag"), std::string::npos) << said;
  EXPECT_EQ(run_.printed, "");
  EXPECT_FALSE(fs::exists(folder_ / "new"));
  fs::create_directories(folder_ / "old");
  run({"--simulation", kBench, "--output", path("old"), "--drive", path("text.bag")});
  EXPECT_TRUE(fs::exists(folder_ / "old")) << "somebody else's folder";
}

TEST_F(SimulateTool, SaysWhatADrivenModelIsLikeAndWhatItMissed) {
  fsr::dataset::Recording recording;
  recording.name = "bare";
  recording.layout = {{2, 5}, 0.02, 0.02};
  recording.full_scale = 1023;
  recording.conditions = {fsr::matrix::Surface{}};
  recording.start_ns = 1700000000000000000;
  for (int i = 0; i < 20; ++i) {
    recording.time.push_back(0.1 * i);
    recording.pressure.push_back(1e4 * i);
    recording.condition.push_back(0);
    recording.counts.insert(recording.counts.end(), 10, std::uint16_t(i));
  }
  writeBag(path("bare.bag"), recording);
  const std::string printed =
      run({"--simulation", kBench, "--output", path("model"), "--drive", path("bare.bag")});
  EXPECT_EQ(run_.status, 0) << printed;
  EXPECT_TRUE(test_support::holds(printed, {"the matrix has 2 x 5 taxels", "holds no temperature",
                                            "the simulated matrix lies flat there"}));
  const auto truth = fsr::simulation::readSimulationFile(path("model/truth.yaml"));
  EXPECT_EQ(truth.layout.size, (fsr::matrix::MatrixSize{2, 5}));
  EXPECT_EQ(truth.fullScale(), 1023);
}

TEST_F(SimulateTool, LeavesTheOriginalAlone) {
  run({"--simulation", kBench, "--output", path("real")});
  const std::string complaint =
      run({"--simulation", kBench, "--output", path("real"), "--drive", path("real/1_flat.bag")});
  EXPECT_NE(complaint.find("would be overwritten"), std::string::npos) << complaint;
}

TEST_F(SimulateTool, OverwritesItsOwnBagsButNobodyElses) {
  std::ofstream(path("recorded.bag")) << "x";
  const std::string complaint = run({"--simulation", kBench, "--output", folder_});
  EXPECT_TRUE(test_support::holds(complaint, {"holds recorded.bag, which was not written by simulate"}));
  EXPECT_EQ(filesIn(folder_), (std::set<std::string>{"recorded.bag"}));
  run({"--simulation", kBench, "--output", path("out")});
  run({"--simulation", kBench, "--output", path("out")});
  EXPECT_EQ(run_.status, 0);
}

// What a run tells: its steps in their order, with the shares of each.
struct Told {
  std::vector<std::pair<std::string, std::vector<double>>> steps;

  std::function<void(const std::string&, double)> listener() {
    return [this](const std::string& step, double share) {
      if (steps.empty() || steps.back().first != step) steps.push_back({step, {}});
      steps.back().second.push_back(share);
    };
  }
};

TEST_F(SimulateTool, TellsTheShareOfTheSessionThatIsSimulated) {
  const auto settings = fsr::simulation::readSimulationFile(kBench);
  const auto duration = [&](std::size_t i) {
    return fsr::simulation::pressureProfile(settings.session[i].program).duration();
  };
  const double first = duration(0) / (duration(0) + duration(1));
  Told told;
  SimulatedBags bags;
  bags.output = folder_;
  bags.told = told.listener();
  writeSessionBags(settings, bags);
  ASSERT_EQ(told.steps.size(), 2u);
  EXPECT_EQ(told.steps[0].first, "simulating 1_flat");
  EXPECT_EQ(told.steps[1].first, "simulating 2_cylinder_5cm");
  std::vector<double> shares;
  for (const auto& [step, some] : told.steps) shares.insert(shares.end(), some.begin(), some.end());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.front(), 0);
  EXPECT_NEAR(told.steps[0].second.back(), first, 0.01);
  EXPECT_NEAR(shares.back(), 1, 0.01);
  EXPECT_LE(shares.back(), 1);
  EXPECT_GT(shares.size(), 40u);  // one a second of rig time
}

TEST_F(SimulateTool, TellsHowFarItIsWithEachBagThatDrivesIt) {
  run({"--simulation", kBench, "--output", path("out")});
  const std::string bag = path("out/1_flat.bag");
  fs::create_directories(path("new"));
  Told told;
  SimulatedBags bags;
  bags.output = path("new");
  bags.told = told.listener();
  writeDrivenBags(fsr::simulation::readSimulationFile(kBench), {{bag}}, bags);
  ASSERT_EQ(told.steps.size(), 3u);
  const std::string steps[] = {"reading " + bag, "simulating " + bag, "writing " + path("new/1_flat.bag")};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(told.steps[i].first, steps[i]);
    const std::vector<double>& shares = told.steps[i].second;
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end())) << steps[i];
    EXPECT_GT(shares.back(), i == 0 ? 0.0 : 0.99) << steps[i];
    EXPECT_LE(shares.back(), 1.0) << steps[i];
  }
}

TEST_F(SimulateTool, ListsEveryEffect) {
  const std::string text = run({"--list-effects"});
  for (const char* word :
       {"hysteresis: ", "loop_width", "plausible", "humidity: ", "two_humidities", "uneven_load"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(run({"--list-effects", "--effect", "humidity"}).find("humidity: "), 0u);
  EXPECT_TRUE(
      test_support::holds(run({"--list-effects", "--effect", "hysterese"}), {"no effect has that name"}));
}

TEST_F(SimulateTool, DrawsWhatAnEffectDoes) {
  const std::string printed =
      run({"--simulation", kBench, "--output", path("out"), "--plot", "--effect", "creep"});
  ASSERT_EQ(run_.status, 0) << printed;
  const std::string bytes = test_support::contentOf(path("out/creep.png"));
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  EXPECT_GT(bytes.size(), 10000u);
  EXPECT_EQ(filesIn(path("out")), (std::set<std::string>{"creep.json", "creep.pdf", "creep.png"}));
}

TEST_F(SimulateTool, SaysWhatItCannotUse) {
  EXPECT_NE(run({"--output", path("out")}).find("--simulation"), std::string::npos);
  EXPECT_NE(run({"--simulation", kBench}).find("--output"), std::string::npos);
  EXPECT_TRUE(
      test_support::holds(run({"--simulation", kBench, "--output", path("out"), "some.bag"}), {"--drive"}));
  EXPECT_TRUE(test_support::holds(
      run({"--simulation", kBench, "--output", path("out"), "--effect", "hysterese"}), {"hysterese"}));
  std::ofstream(path("file")) << "x";
  EXPECT_TRUE(
      test_support::holds(run({"--simulation", kBench, "--output", path("file")}), {"cannot be created"}));
  EXPECT_FALSE(fs::exists(path("out/1_flat.bag")));
}

TEST_F(SimulateTool, WritesSeveralSheetsAsItWritesEachAlone) {
  run({"--simulation", kBench, "--output", path("out"), "--seed", "2", "--sheets", "2"});
  EXPECT_EQ(filesIn(path("out")), (std::set<std::string>{"sheet_2", "sheet_3"}));
  run({"--simulation", kBench, "--output", path("alone"), "--seed", "3"});
  for (const char* const bag : {"/1_flat.bag", "/2_cylinder_5cm.bag"}) {
    EXPECT_EQ(fsr::settings::sha256OfFile(path("out/sheet_3") + bag),
              fsr::settings::sha256OfFile(path("alone") + bag));
  }
  for (const std::string option : {"--save-state", "--plot"}) {
    std::vector<std::string> words = {"--simulation", kBench, "--output", path("new"), "--sheets", "2"};
    words.push_back(option);
    if (option == "--save-state") words.push_back(path("state.yaml"));
    EXPECT_NE(run(words).find(option + " cannot be used with --sheets"), std::string::npos);
  }
  EXPECT_FALSE(fs::exists(path("new")));
}

}  // namespace
}  // namespace fsr_ros
