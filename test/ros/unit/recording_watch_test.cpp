#include "ros/recording/session_server.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/pty.h"

namespace {

using Level = diagnostic_msgs::DiagnosticStatus;
using fsr_ros::RecordingLook;

constexpr std::uint64_t kLeast = 200'000'000;

class RecordingWatch : public testing::Test {
 protected:
  diagnostic_updater::DiagnosticStatusWrapper at(double time, const RecordingLook& look) {
    diagnostic_updater::DiagnosticStatusWrapper status;
    watch_.judge(look, time, status);
    return status;
  }
  static bool says(const diagnostic_updater::DiagnosticStatusWrapper& status, const std::string& part) {
    return status.message.find(part) != std::string::npos;
  }
  fsr_ros::RecordingWatch watch_{kLeast, 10};
};

TEST_F(RecordingWatch, IsOkWhileTheBagGrows) {
  at(0, {"x.bag.active", 1000, 2 * kLeast});
  const auto status = at(8, {"x.bag.active", 9000, 2 * kLeast});
  EXPECT_EQ(status.level, Level::OK);
  EXPECT_TRUE(says(status, "x.bag.active")) << status.message;
}

TEST_F(RecordingWatch, ReportsAnErrorWhenTheDiskIsNearlyFull) {
  const auto status = at(0, {"x.bag.active", 1000, kLeast - 1});
  EXPECT_EQ(status.level, Level::ERROR);
  EXPECT_TRUE(says(status, "RECORDING STOPPED: 200.0 MB are left")) << status.message;
}

TEST_F(RecordingWatch, ReportsAnErrorWhenTheBagDoesNotGrow) {
  at(0, {"x.bag.active", 1000, 2 * kLeast});
  EXPECT_EQ(at(9, {"x.bag.active", 1000, 2 * kLeast}).level, Level::OK);
  const auto status = at(11, {"x.bag.active", 1000, 2 * kLeast});
  EXPECT_EQ(status.level, Level::ERROR);
  EXPECT_TRUE(says(status, "has not grown for 11 s")) << status.message;
  EXPECT_EQ(at(12, {"x.bag.active", 1001, 2 * kLeast}).level, Level::OK) << "it goes on";
}

TEST_F(RecordingWatch, ReportsAnEndedAndAMissingRecording) {
  EXPECT_TRUE(says(at(0, {}), "waiting for the recorder"));
  EXPECT_TRUE(says(at(1, {"x.bag", 1000, kLeast}), "has ended"));
}

TEST(LookAtRecording, FindsTheBagUnderBothOfItsNames) {
  const test_support::TemporaryFolder folder;
  EXPECT_EQ(fsr_ros::lookAtRecording(folder.path("x")).file, "");
  std::ofstream(folder.path("x.bag")) << "12345";
  EXPECT_EQ(fsr_ros::lookAtRecording(folder.path("x")).file, folder.path("x.bag"));
  EXPECT_EQ(fsr_ros::lookAtRecording(folder.path("x.bag")).size, 5u);
  EXPECT_GT(fsr_ros::lookAtRecording(folder.path("x")).space, 0u);
  std::ofstream(folder.path("x.bag.active")) << "1";
  EXPECT_EQ(fsr_ros::lookAtRecording(folder.path("x")).file, folder.path("x.bag.active"));
}

}  // namespace
