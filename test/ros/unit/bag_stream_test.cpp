#include "ros/bags/bag_stream.h"

#include <fsr_pressure_map/CalibrationInfo.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "support/pty.h"
#include "support/source_dir.h"

namespace fsr_ros {
namespace {

using Read = std::tuple<std::string, std::uint64_t, std::string>;  // topic, reception [ns], text

// rosbag is the reference.
std::vector<Read> byView(const std::string& path, const std::vector<std::string>& topics) {
  const rosbag::Bag bag(path);
  rosbag::View view;
  if (topics.empty()) {
    view.addQuery(bag);
  } else {
    view.addQuery(bag, rosbag::TopicQuery(topics));
  }
  std::vector<Read> read;
  for (const rosbag::MessageInstance& message : view) {
    read.emplace_back(message.getTopic(), message.getTime().toNSec(),
                      message.instantiate<std_msgs::String>()->data);
  }
  return read;
}

std::vector<Read> byStream(const std::string& path, const std::vector<std::string>& topics) {
  std::vector<Read> read;
  const auto take = [&](const StreamedMessage& message) {
    read.emplace_back(message.about.topic, message.received.toNSec(),
                      readStreamed<std_msgs::String>(message).data);
    return true;
  };
  withBagStream(path, [&](const BagStream& bag) {
    const std::uint64_t taken = bag.forEach({topics}, take);
    EXPECT_EQ(taken, read.size());
  });
  return read;
}

class BagStreamTest : public testing::Test {
 protected:
  // Messages of several topics in small chunks. Times come in steps of 10 ms, so that many are equal, and
  // with `jitter` not in order: chunks then overlap in time.
  void write(rosbag::CompressionType packing, int jitter) {
    std::mt19937 random(1);
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    bag.setChunkThreshold(2000);
    bag.setCompression(packing);
    for (int i = 0; i < 2000; ++i) {
      std_msgs::String message;
      message.data = std::to_string(i);
      const int late = jitter > 0 ? static_cast<int>(random() % static_cast<unsigned>(jitter)) : 0;
      const std::string topic = "/t" + std::to_string(random() % 5);
      bag.write(topic, ros::Time(100 + 0.01 * (i / 3 + late)), message);
      if (i == 700) bag.write("/rare", ros::Time(100 + 0.01 * (i / 3)), message);
    }
  }

  const test_support::TemporaryFolder folder_;
  const std::string path_ = folder_.path("a.bag");
};

TEST_F(BagStreamTest, GivesMessagesInTheOrderOfRosbagsView) {
  for (const auto packing : {rosbag::compression::Uncompressed, rosbag::compression::LZ4}) {
    for (const int jitter : {0, 5, 300}) {
      write(packing, jitter);
      for (const std::vector<std::string>& topics :
           {std::vector<std::string>{}, {"/t3"}, {"/t1", "/rare"}, {"/none"}}) {
        EXPECT_EQ(byStream(path_, topics), byView(path_, topics)) << jitter;
      }
    }
  }
}

TEST_F(BagStreamTest, ListsTheConnectionsThatHaveAMessage) {
  write(rosbag::compression::Uncompressed, 5);
  withBagStream(path_, [&](const BagStream& bag) {
    EXPECT_EQ(bag.connections().size(), 6u);
    EXPECT_EQ(bag.begin(), ros::Time(100));
  });
}

TEST_F(BagStreamTest, EndsWhereTheReaderHasEnough) {
  write(rosbag::compression::Uncompressed, 0);
  std::size_t seen = 0;
  withBagStream(path_, [&](const BagStream& bag) {
    bag.forEach({}, [&](const StreamedMessage&) { return ++seen < 10; });
  });
  EXPECT_EQ(seen, 10u);
}

TEST_F(BagStreamTest, TellsHowMuchIsDone) {
  write(rosbag::compression::Uncompressed, 0);
  std::vector<double> shares;
  StreamQuery query;
  query.progress = [&](double share) { shares.push_back(share); };
  withBagStream(
      path_, [&](const BagStream& bag) { bag.forEach(query, [](const StreamedMessage&) { return true; }); });
  ASSERT_FALSE(shares.empty());
  EXPECT_GE(shares.front(), 0);
  EXPECT_LE(shares.back(), 1);
}

// The bag was recorded before CalibrationInfo had parent and corrected.
TEST(BagStreamOfAnEarlierVersion, HasACalibrationWithoutAParent) {
  const std::string old = test_support::sourceDir() + "/test/data/indenter_map.bag";
  std::vector<fsr_pressure_map::CalibrationInfo> read;
  withBagStream(old, [&](const BagStream& bag) {
    StreamQuery query;
    query.topics = {"/fsr/calibration_info"};
    bag.forEach(query, [&](const StreamedMessage& message) {
      EXPECT_NE(message.about.md5sum, ros::message_traits::md5sum<fsr_pressure_map::CalibrationInfo>());
      read.push_back(readStreamed<fsr_pressure_map::CalibrationInfo>(message));
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
