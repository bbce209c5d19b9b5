// ROS time that jumps back: `rosbag play --loop --clock` with the calibration node and the view node.
#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "ros/bags/bag_writer.h"
#include "ros/bags/resource_path.h"
#include "support/ros_listener.h"
#include "support/small_calibration.h"
#include "support/small_tables.h"

namespace {

using fsr_pressure_map::PressureMap;
using test_support::await;
using test_support::Listener;

const std::string kLoopFolder = fsr_ros::rosHome() + "/looped_bag_test";  // as in looped_bag.test
const std::string kBag = kLoopFolder + "/loop.bag";
const fsr::matrix::MatrixSize kLoopSize{3, 4};
constexpr std::uint16_t kFullScale = 1023;
constexpr std::int64_t kStart = 1'500'000'000'000'000'000;  // [ns]
constexpr std::int64_t kScanPeriod = 20'000'000;            // [ns]
constexpr int kScans = 200;                                 // 4 s
constexpr std::int64_t kCurvatureAt =
    3'900'000'000;                  // [ns], sent once: in the future after time has jumped back
constexpr double kStaleFrom = 2.0;  // [s] since kStart: ages start from 0 in each round

void writeLoop() {
  std::filesystem::create_directories(kLoopFolder);
  fsr_ros::BagWriter bag(kBag);
  for (int i = 0; i < kScans; ++i) {
    if (i * kScanPeriod == kCurvatureAt) {
      bag.addSurface(kStart + kCurvatureAt, {"flat", 1, {fsr::matrix::Curvature{}}, {}});
    }
    const std::vector<std::uint16_t> counts(kLoopSize.taxels(), static_cast<std::uint16_t>(300 + i));
    bag.addScan(kStart + i * kScanPeriod, static_cast<std::uint32_t>(i),
                {kLoopSize, kFullScale, counts.data(), counts.size()});
  }
  bag.close();
}

/// Runs rosbag play until it is destroyed.
class Player {
 public:
  Player() : pid_(fork()) {
    if (pid_ != 0) return;
    execlp("rosrun", "rosrun", "rosbag", "play", "--quiet", "--loop", "--clock", "--rate", "2", kBag.c_str(),
           static_cast<char*>(nullptr));
    _exit(1);
  }
  ~Player() {
    kill(pid_, SIGINT);
    waitpid(pid_, nullptr, 0);
  }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

 private:
  pid_t pid_;
};

double sinceStart(const ros::Time& stamp) {
  return 1e-9 * static_cast<double>(static_cast<std::int64_t>(stamp.toNSec()) - kStart);
}

bool isTheTables(const PressureMap& map, std::uint16_t code) {
  for (std::size_t i = 0; i < map.pressure.size(); ++i) {
    if (map.pressure[i] != test_support::knownPressure(i, 0, code)) return false;
  }
  return !map.pressure.empty();
}

TEST(LoopedBag, ContinuesInEachRoundWithoutStateOfTheRoundBefore) {
  writeLoop();
  fsr::calibration::saveCalibration(test_support::smallCalibration(kLoopSize, {0.0, 10.0}, "", kFullScale),
                                    kLoopFolder + "/calibration.h5");
  const Listener<PressureMap> maps("pressure_map");
  const Listener<fsr_pressure_map::PressureStatisticsArray> statistics("statistics");
  ASSERT_TRUE(maps.connected());
  ASSERT_TRUE(statistics.connected());
  const Listener<fsr_pressure_map::CalibrationInfo> info("calibration_info");
  ASSERT_TRUE(await([&] { return !info.messages.empty() && !info.messages.back()->id.empty(); }));
  {
    const Player player;
    int rounds = 0;
    std::size_t seen = 1;
    ASSERT_TRUE(await([&] {
      for (; seen < maps.messages.size(); ++seen) {
        rounds += maps.messages[seen]->header.stamp < maps.messages[seen - 1]->header.stamp;
      }
      return rounds >= 3;
    })) << "three times back to the start";
  }
  std::map<int, int> of_round;  // number of maps of each round
  int round = 0;
  for (std::size_t i = 0; i < maps.messages.size(); ++i) {
    const PressureMap& map = *maps.messages[i];
    if (i > 0 && map.header.stamp < maps.messages[i - 1]->header.stamp) ++round;
    ++of_round[round];
    const double time = sinceStart(map.header.stamp);
    const auto code = static_cast<std::uint16_t>(300 + std::lround(time * 1e9 / kScanPeriod));
    ASSERT_TRUE(isTheTables(map, code)) << "round " << round << " at " << time << " s";
    if (round == 0 || std::abs(time - kStaleFrom) < 0.1 || time > 3.8)
      continue;  // the curvature is known from then on
    EXPECT_EQ(map.state, time < kStaleFrom ? PressureMap::STATE_OK : PressureMap::STATE_CURVATURE_STALE)
        << "round " << round << " at " << time << " s";
  }
  EXPECT_EQ(of_round[1], kScans) << "a whole round, no scan lost";
  EXPECT_EQ(of_round[2], kScans);
  for (const auto& message : statistics.messages) {
    for (const auto& region : message->regions) {
      EXPECT_GE(region.duration, 0);
      EXPECT_LE(region.duration, 4.01) << "no integral over two rounds";
    }
  }
}

}  // namespace
