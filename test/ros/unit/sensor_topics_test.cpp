#include "ros/bags/sensor_topics.h"

#include <fsr_pressure_map/CalibrationInfo.h>
#include <gtest/gtest.h>
#include <std_msgs/String.h>

#include <string>
#include <vector>

#include "ros/messages/message_reader.h"
#include "support/pty.h"
#include "support/source_dir.h"

namespace fsr_ros {
namespace {

TEST(ForEachMessage, GivesTheMessagesOfTheseTopicsUntilTheReaderHasEnough) {
  const test_support::TemporaryFolder folder;
  const std::string path = folder.path("a.bag");
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    for (int i = 0; i < 12; ++i) {
      std_msgs::String message;
      message.data = std::to_string(i);
      bag.write("/t" + std::to_string(i % 3), ros::Time(200 - i), message);
    }
  }
  std::vector<std::string> read;
  std::vector<double> shares;
  MessageReader reader;
  withSoundBag(path, [&](const rosbag::Bag& bag) {
    EXPECT_EQ(typesIn(bag).size(), 3u);
    const auto take = [&](const rosbag::MessageInstance& message) {
      read.push_back(reader.read<std_msgs::String>(message).data);
      return read.size() < 3;
    };
    forEachMessage(bag, {"/t1"}, take, [&](double share) { shares.push_back(share); });
  });
  EXPECT_EQ(read, (std::vector<std::string>{"10", "7", "4"}));
  EXPECT_EQ(shares, std::vector<double>{0});
}

// The bag was recorded before CalibrationInfo had parent and corrected.
TEST(MessageReader, ReadsACalibrationOfAnEarlierVersionWithoutAParent) {
  const std::string old = test_support::sourceDir() + "/test/data/indenter_map.bag";
  std::vector<fsr_pressure_map::CalibrationInfo> read;
  MessageReader reader;
  withSoundBag(old, [&](const rosbag::Bag& bag) {
    forEachMessage(bag, {"/fsr/calibration_info"}, [&](const rosbag::MessageInstance& message) {
      EXPECT_NE(message.getMD5Sum(), ros::message_traits::md5sum<fsr_pressure_map::CalibrationInfo>());
      read.push_back(reader.read<fsr_pressure_map::CalibrationInfo>(message));
      return true;
    });
  });
  ASSERT_FALSE(read.empty());
  EXPECT_EQ(read[0].scheme, "per_curvature");
  EXPECT_GT(read[0].pressure_high, 600e3);
  EXPECT_FALSE(read[0].class_curvatures.empty());
  EXPECT_EQ(read[0].parent, "");
  EXPECT_EQ(read[0].corrected, "");
}

}  // namespace
}  // namespace fsr_ros
