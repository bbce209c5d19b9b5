// The training node compared with the tool `train`: a bag that is replayed without loss gives the same
// tables.

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <fsr_pressure_map/Event.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <signal.h>
#include <std_srvs/Trigger.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "compensation/training_statistics.h"
#include "dataset/unsound_spans.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "ros/bags/bag_writer.h"
#include "ros/bags/resource_path.h"
#include "support/holds.h"
#include "support/program_output.h"
#include "support/ros_listener.h"
#include "support/synthetic_recording.h"

namespace {

namespace fs = std::filesystem;

/// `rosbag play` in its own process group; it keeps its connections until it is destroyed.
class Replay {
 public:
  explicit Replay(const std::string& bag) : child_(::fork()) {
    if (child_ != 0) return;
    ::setpgid(0, 0);
    ::execlp("rosrun", "rosrun", "rosbag", "play", "--wait-for-subscribers", "--keep-alive", "--quiet", "-r",
             "40", bag.c_str(), nullptr);
    ::_exit(127);
  }
  ~Replay() {
    ::kill(-child_, SIGTERM);
    ::waitpid(child_, nullptr, 0);
  }

 private:
  pid_t child_;
};

class Training : public testing::Test {
 protected:
  Training() : folder_(fs::path(testing::TempDir()) / ("training_test_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    gathered_ = handle_.subscribe<diagnostic_msgs::DiagnosticStatus>(
        "training/gathered", 10, [this](const diagnostic_msgs::DiagnosticStatus::ConstPtr& status) {
          for (const auto& value : status->values) counts_[value.key] = std::stoul(value.value);
          message_ = status->message;
        });
  }
  ~Training() override { fs::remove_all(folder_); }

  ros::NodeHandle handle_;
  fs::path folder_;
  ros::Subscriber gathered_;
  std::map<std::string, std::size_t> counts_;
  std::string message_;
};

std::map<std::string, std::size_t> messagesIn(const std::string& path) {
  std::map<std::string, std::size_t> counts;
  const rosbag::Bag bag(path, rosbag::bagmode::Read);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    if (!message.isType<fsr_pressure_map::Event>())  // the node counts what it is trained with
      ++counts[fs::path(message.getTopic()).filename().string()];
  }
  return counts;
}

// As the conductor does it where the sheet was taken off.
void addReject(const std::string& path, double time) {
  rosbag::Bag bag(path, rosbag::bagmode::Append);
  fsr_pressure_map::Event event;
  event.header.stamp = ros::Time(1500000000 + time);
  event.kind = "reject";
  event.label =
      fsr::dataset::rejectLabel("step 1", fsr::dataset::RejectReason::kSheetOff, "the sheet is off");
  bag.write("/fsr/events", event.header.stamp, event);
}

fsr::calibration::Calibration trainedByTool(const std::string& bag, const std::string& output) {
  const test_support::ProgramOutput tool =
      test_support::outputOf("rosrun fsr_pressure_map train " + bag + " --output " + output + " 2>&1");
  EXPECT_EQ(tool.status, 0) << tool.text;
  return fsr::calibration::loadCalibration(output, fsr::calibration::CalibrationParts::kAll);
}

TEST_F(Training, SaysWhatItWaitsFor) {
  ASSERT_TRUE(test_support::await([this] { return !message_.empty(); }));
  EXPECT_EQ(message_, "waiting for raw, chamber_pressure, curvature");
  const std_srvs::Trigger::Response answer = test_support::call<std_srvs::Trigger>("training/train");
  EXPECT_FALSE(answer.success);
  EXPECT_TRUE(test_support::holds(answer.message, {"chamber_pressure", "/fsr"}));
}

TEST_F(Training, AReplayedBagGivesTheTablesOfTheTool) {
  const std::string bag = (folder_ / "two_surfaces.bag").string();
  test_support::SyntheticRig rig;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_7cm", 14.25}};
  rig.scans_per_cycle = 60;
  fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
  recording.start_ns = 1500000000000000000;
  recording.temperature.assign(recording.scans(), 23.5);
  fsr_ros::writeBag(bag, recording);
  addReject(bag, recording.time[recording.scans() / 4]);

  const auto expected = messagesIn(bag);
  {
    const Replay replay(bag);
    ASSERT_TRUE(test_support::await([&] {
      for (const auto& [topic, count] : expected) {
        if (counts_[topic] != count) return false;
      }
      return true;
    })) << "gathered "
        << counts_["raw"] << " of " << expected.at("raw") << " scans";
  }
  EXPECT_EQ(message_, "ready to train");
  const std_srvs::Trigger::Response answer = test_support::call<std_srvs::Trigger>("training/train");
  ASSERT_TRUE(answer.success) << answer.message;
  const std::string output = fsr_ros::rosHome() + "/trained_on_topics.h5";
  EXPECT_NE(answer.message.find(" is in " + output), std::string::npos) << answer.message;

  const fsr::calibration::Calibration live =
      fsr::calibration::loadCalibration(output, fsr::calibration::CalibrationParts::kAll);
  const fsr::calibration::Calibration direct = trainedByTool(bag, (folder_ / "direct.h5").string());
  EXPECT_EQ(live.statistics->cells, direct.statistics->cells);
  ASSERT_EQ(live.tables.tables.size(), direct.tables.tables.size());
  for (std::size_t i = 0; i < direct.tables.tables.size(); ++i) {
    EXPECT_EQ(live.tables.tables[i].pressure, direct.tables.tables[i].pressure);
    EXPECT_EQ(live.tables.tables[i].deviation, direct.tables.tables[i].deviation);
    EXPECT_EQ(live.tables.tables[i].support, direct.tables.tables[i].support);
  }
  EXPECT_EQ(live.scores.whole.rmse_percent.mean, direct.scores.whole.rmse_percent.mean);
  EXPECT_EQ(live.trained.temperature.high, direct.trained.temperature.high);
  EXPECT_EQ(live.warnings.size(), direct.warnings.size());
  const auto rejected = [](const std::string& warning) {
    return warning.find("sheet_off") != std::string::npos;
  };
  EXPECT_EQ(std::count_if(live.warnings.begin(), live.warnings.end(), rejected), 1);
}

TEST_F(Training, ClearRemovesWhatWasCollected) {
  const std_srvs::Trigger::Response answer = test_support::call<std_srvs::Trigger>("training/clear");
  EXPECT_TRUE(answer.success);
  EXPECT_EQ(answer.message, "removed 600 scans");
  EXPECT_TRUE(
      test_support::await([this] { return message_ == "waiting for raw, chamber_pressure, curvature"; }));
}

}  // namespace
