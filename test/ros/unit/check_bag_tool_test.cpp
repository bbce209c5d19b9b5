#include "ros/tools/tools.h"

#include <fsr_pressure_map/Event.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_topics.h"
#include "ros/bags/bag_writer.h"
#include "support/folder_test.h"
#include "support/mounted_day.h"
#include "support/synthetic_recording.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kStart = 1500000000000000000;  // [ns]

class CheckBagTool : public test_support::FolderTest {
 protected:
  std::string record(bool with_chamber = true) const {
    test_support::SyntheticRig rig;
    rig.size = {3, 4};
    fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
    recording.start_ns = kStart;
    if (!with_chamber) recording.pressure.clear();
    const std::string path = (folder_ / "session.bag").string();
    writeBag(path, recording);
    return path;
  }

  // Returns the exit status, or -1 after an InputError; the output or the message is in said_.
  int run(const std::vector<std::string>& words) {
    const test_support::ToolRun run = test_support::runTool(checkBagTool, "check_bag", words);
    said_ = run.said();
    return run.status;
  }
  bool says(const std::string& words) const { return said_.find(words) != std::string::npos; }
  bool ends(const std::string& words) const {
    return said_.size() >= words.size() && said_.substr(said_.size() - words.size()) == words;
  }

  std::string said_;
};

TEST_F(CheckBagTool, EndsWithItsVerdict) {
  EXPECT_EQ(run({record()}), 0);
  EXPECT_TRUE(ends("\nFit for training and for discrepancy.\n")) << said_;
  EXPECT_TRUE(says("/fsr/raw"));
  EXPECT_TRUE(says("Coverage"));
}

TEST_F(CheckBagTool, NamesTheMountsThatDifferFromTheOthersOfTheirSurface) {
  for (const bool wrong : {true, false}) {
    std::vector<std::string> paths;
    for (const fsr::dataset::Recording& mount : test_support::recorded({"bench", 2, wrong})) {
      paths.push_back((folder_ / (wrong ? "wrong_" + mount.name : mount.name)).string());
      writeBag(paths.back(), mount);
    }
    EXPECT_EQ(run(paths), 0);
    EXPECT_EQ(says("\nMounts differ: cylinder_10cm: mount 1 (wrong_1_cylinder_10cm.bag) and mount 5 "
                   "(wrong_5_cylinder_10cm.bag) differ by "),
              wrong)
        << said_;
    EXPECT_EQ(ends(" First look at the mounts that differ.\n"), wrong) << said_;
  }
}

TEST_F(CheckBagTool, ReportsNotFitAlsoByItsExitStatusIfStrict) {
  const std::string bag = record(false);
  EXPECT_EQ(run({bag}), 0);
  EXPECT_TRUE(says("\nNot fit, because session.bag: no chamber pressure is recorded")) << said_;
  EXPECT_EQ(run({bag, "--strict"}), 1);
}

TEST_F(CheckBagTool, JudgesASocketWithoutReference) {
  EXPECT_EQ(run({"--use", "socket", record(false)}), 0);
  EXPECT_TRUE(ends("no reference: accuracy not assessed.\n")) << said_;
  EXPECT_TRUE(says("Longest static load"));
}

TEST_F(CheckBagTool, DoesNotCallASocketBagFitForTraining) {
  test_support::SyntheticRig rig;
  rig.surfaces = {{"flat", 0.0}, {"bent", 10.0}};
  fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
  recording.start_ns = kStart;
  const std::string path = (folder_ / "worn.bag").string();
  BagOptions options;
  writeBag(path, recording, options);
  EXPECT_EQ(run({"--strict", path}), 0) << said_;
  options.session.session_id = "2026-03-01";
  options.session.use = "socket";
  fs::remove(path);
  writeBag(path, recording, options);
  EXPECT_EQ(run({"--strict", path}), 1);
  EXPECT_TRUE(says("worn.bag was recorded in a socket")) << said_;
  EXPECT_TRUE(ends("check it with --use socket.\n")) << said_;
}

TEST_F(CheckBagTool, TakesDonAndDoffFromTheEvents) {
  const std::string path = record(false);
  {
    rosbag::Bag bag(path, rosbag::bagmode::Append);
    for (const auto& [kind, seconds] : {std::pair{"don", 5}, std::pair{"doff", 45}}) {
      fsr_pressure_map::Event event;
      event.header.stamp.fromNSec(static_cast<std::uint64_t>(kStart + seconds * 1'000'000'000LL));
      event.kind = kind;
      bag.write("/fsr/events", event.header.stamp, event);
    }
  }
  EXPECT_EQ(eventTimes(path, "don"), std::vector<std::int64_t>{kStart + 5'000'000'000});
  EXPECT_EQ(run({"--use=socket", path}), 0);
}

TEST_F(CheckBagTool, SaysWhetherTheSheetWasConditioned) {
  test_support::SyntheticRig rig;
  rig.size = {3, 4};
  rig.cycles = 10;
  rig.peak = 620e3;
  fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
  recording.start_ns = kStart;
  const std::string plain = (folder_ / "plain.bag").string(), full = (folder_ / "conditioned.bag").string();
  writeBag(plain, recording);
  for (std::size_t i = 0; i < 5 * rig.scans_per_cycle; ++i) recording.pressure[i] *= 1.1;
  writeBag(full, recording);
  EXPECT_EQ(run({plain}), 0);
  EXPECT_TRUE(says("\nNote: conditioning: not seen: the first loadings of a sheet differ from later ones"))
      << said_;
  EXPECT_EQ(run({full}), 0);
  EXPECT_TRUE(says("\nNote: conditioning: 5 cycles to 682 kPa seen\n")) << said_;
  {
    rosbag::Bag bag(plain, rosbag::bagmode::Append);
    fsr_pressure_map::Event event;
    event.header.stamp.fromNSec(static_cast<std::uint64_t>(kStart + 1'000'000'000LL));
    event.kind = "conditioning";
    bag.write("/fsr/events", event.header.stamp, event);
  }
  EXPECT_EQ(run({plain}), 0);
  EXPECT_TRUE(says("\nNote: conditioning: marked by an event\n")) << said_;
}

TEST_F(CheckBagTool, CountsStampsThatRunBackwards) {
  const std::string path = (folder_ / "stamps.bag").string();
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    double arrival = 3.0;
    for (const double stamp : {1.0, 1.1, 1.2, 1.2, 1.15, 1.3, 2.3}) {
      fsr_pressure_map::Event event;
      event.header.stamp = ros::Time(stamp);
      bag.write("/fsr/events", ros::Time(arrival += 0.1), event);
    }
  }
  const TopicCourse course = topicCourses(path).at(0);
  EXPECT_TRUE(course.stamped);
  EXPECT_EQ(course.messages, 7u);
  EXPECT_EQ(course.backwards, 1u);
  EXPECT_EQ(course.repeated, 1u);
  EXPECT_NEAR(course.longest_gap, 1.0, 1e-6);
  EXPECT_NEAR(course.latest, 3.5 - 1.15, 1e-6);
}

TEST_F(CheckBagTool, CountsAndNamesAGapThatNoCounterShows) {
  test_support::SyntheticRig rig;
  fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
  recording.start_ns = kStart;
  for (std::size_t i = recording.scans() / 2; i < recording.scans(); ++i) recording.time[i] += 276;
  const std::string path = (folder_ / "table.bag").string();
  writeBag(path, recording);
  EXPECT_EQ(run({path}), 0);
  EXPECT_TRUE(says("\nNote: table.bag: no scan came for 276.1 s (24.9 to 301.0 s)\n")) << said_;
  EXPECT_TRUE(says("\nNote: table.bag: 1 gap between scans, 0 scans lost by the board's counter\n")) << said_;
}

TEST_F(CheckBagTool, NamesAMatrixThatAnswersBeforeTheChamber) {
  fsr::dataset::Recording recording = test_support::syntheticRecording({});
  recording.start_ns = kStart;
  std::rotate(recording.pressure.begin(), recording.pressure.end() - 3, recording.pressure.end());
  const std::string path = (folder_ / "late_reference.bag").string();
  writeBag(path, recording);
  EXPECT_EQ(run({path}), 0);
  EXPECT_TRUE(says(" s before chamber_pressure, which no sheet does")) << said_;
}

TEST_F(CheckBagTool, RefusesWhatItCannotRead) {
  EXPECT_EQ(run({}), -1);
  EXPECT_EQ(run({(folder_ / "none.bag").string()}), -1);
  EXPECT_TRUE(says("no such file"));
  EXPECT_EQ(run({"--use", "shoe", record()}), -1);
  EXPECT_TRUE(says("must be one of chamber, socket"));
  EXPECT_EQ(run({"--calibration", "c.h5", record()}), -1);
}

}  // namespace
}  // namespace fsr_ros
