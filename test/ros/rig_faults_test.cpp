// Faults of a whole rig: driver, curvature, calibration and view node as calibrated.launch starts them, with
// a board that this test emulates. Every map with the state OK is compared with its scan and its board.
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/PressureMap.h>
#include <gtest/gtest.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "emulator/emulator.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "ros/bags/resource_path.h"
#include "support/diagnostics.h"
#include "support/ros_listener.h"
#include "support/small_calibration.h"
#include "support/small_tables.h"
#include "support/source_dir.h"

namespace {

using fsr_pressure_map::MatrixFrame;
using fsr_pressure_map::PressureMap;
using test_support::await;
using test_support::Listener;

constexpr std::uint32_t kOthersClock =
    1'000'000'000;  // [us]: distinguishes the scans of board B from those of A

std::unique_ptr<fsr::emulator::Emulator> makeBoard(const std::string& serial) {
  fsr::emulator::EmulatorOptions options;
  options.simulation =
      fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/bench.yaml");
  options.simulation.board.scan_rate = 100;
  options.simulation.board.serial = serial;
  options.link = ros::NodeHandle("~").param<std::string>("port", "");
  options.clock.offset = serial == "B" ? kOthersClock : 0;
  options.autostart = true;
  return std::make_unique<fsr::emulator::Emulator>(options);
}

// 0 if the node does not answer.
int pidOf(const std::string& node) {
  XmlRpc::XmlRpcValue request, response, uri, answer;
  request[0] = ros::this_node::getName();
  request[1] = ros::names::resolve(node);
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", request, response, uri, false)) return 0;
  if (!ros::network::splitURI(static_cast<std::string>(uri), host, port)) return 0;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue caller;
  caller[0] = ros::this_node::getName();
  if (!client.execute("getPid", caller, answer) || !answer.valid() || answer.size() != 3) return 0;
  return static_cast<int>(answer[2]);
}

class RigFaults : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path folder = fsr_ros::rosHome() + "/faults_test";  // as in rig_faults.test
    std::filesystem::create_directories(folder);
    fsr::calibration::saveCalibration(test_support::smallCalibration({3, 4}, {0.0, 10.0}, "A", 4095),
                                      folder / "calibration.h5");
  }
  void SetUp() override {
    board_ = makeBoard("A");
    ASSERT_TRUE(calibratedMaps(5));
  }

  // Every map with the state OK has the table's pressures for its own scan.
  void TearDown() override {
    std::map<ros::Time, MatrixFrame::ConstPtr> scans;
    for (const auto& scan : raw_.messages) scans[scan->header.stamp] = scan;
    std::size_t compared = 0;
    for (const auto& map : maps_.messages) {
      const auto scan = scans.find(map->header.stamp);
      if (map->state != PressureMap::STATE_OK || scan == scans.end()) continue;
      ++compared;
      ASSERT_LT(scan->second->device_time, kOthersClock)
          << "pressure of a board that is not the calibration's";
      ASSERT_TRUE(isTheTables(*map, *scan->second)) << "at " << map->header.stamp;
    }
    EXPECT_GT(compared, 0u);
  }

  static bool isTheTables(const PressureMap& map, const MatrixFrame& scan) {
    for (std::size_t i = 0; i < scan.counts.size(); ++i) {
      const bool none = std::isnan(map.pressure[i]) && map.flags[i] != 0;
      if (!none && map.pressure[i] != test_support::knownPressure(i, 0, scan.counts[i])) return false;
    }
    return true;
  }

  // Waits for this many further maps with the state OK.
  bool calibratedMaps(std::size_t count) { return mapsOfState(PressureMap::STATE_OK, count); }
  bool mapsOfState(int state, std::size_t count) {
    std::size_t seen = maps_.messages.size(), good = 0;
    return await([&] {
      for (; seen < maps_.messages.size(); ++seen) good += maps_.messages[seen]->state == state;
      return good >= count;
    });
  }

  Listener<MatrixFrame> raw_{"raw"};
  Listener<PressureMap> maps_{"pressure_map"};
  std::unique_ptr<fsr::emulator::Emulator> board_;
};

TEST_F(RigFaults, EachNodeMayBeKilledAndComesBack) {
  for (const std::string node : {"driver", "calibration", "curvature", "view"}) {
    const int pid = pidOf(node);
    ASSERT_GT(pid, 0) << node;
    ASSERT_EQ(kill(pid, SIGKILL), 0);
    ASSERT_TRUE(await([&] {
      const int now = pidOf(node);
      return now > 0 && now != pid;
    })) << node;
    ASSERT_TRUE(calibratedMaps(20)) << node;
  }
}

TEST_F(RigFaults, AnotherBoardOnThePortNeverPassesForTheCalibrations) {
  board_.reset();
  board_ = makeBoard("B");
  ASSERT_TRUE(mapsOfState(PressureMap::STATE_WRONG_SENSOR, 20));
  board_.reset();
  board_ = makeBoard("A");
  ASSERT_TRUE(calibratedMaps(20));
}

TEST_F(RigFaults, TheLossesOfABadLineAreCountedInDiagnostics) {
  test_support::Diagnostics diagnostics;
  fsr::emulator::LineDamage damage;
  damage.lost_packets = 0.2;
  damage.flipped_bits = 1e-4;
  board_->setDamage(damage);
  ASSERT_TRUE(
      await([&] { return std::atoi(diagnostics.valueOf("fsr/driver: scans", "scans lost").c_str()) > 10; }));
  board_->setDamage({});
  ASSERT_TRUE(calibratedMaps(20));
}

}  // namespace
