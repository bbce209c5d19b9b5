#include <fsr_pressure_map/LoadFile.h>
#include <gtest/gtest.h>
#include <nodelet/NodeletList.h>
#include <nodelet/NodeletUnload.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <future>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "support/calibration_rig.h"
#include "support/small_calibration.h"
#include "support/small_tables.h"

namespace {

using fsr_pressure_map::PressureMap;
using test_support::CalibrationRig;

bool isLoaded(const std::string& name) {
  nodelet::NodeletList list;
  EXPECT_TRUE(ros::service::call("manager/list", list));
  const auto& loaded = list.response.nodelets;
  return std::find(loaded.begin(), loaded.end(), name) != loaded.end();
}

TEST(CalibrationNodelet, CalibratesAndShowsInsideARealManager) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("nodelet_test_" + std::to_string(::getpid()) + ".h5"))
          .string();
  fsr::calibration::saveCalibration(test_support::smallCalibration({3, 4}, {0.0, 10.0}), file);
  CalibrationRig rig;
  ASSERT_TRUE(rig.connected());
  EXPECT_TRUE(isLoaded("/fsr/calibration"));
  EXPECT_TRUE(isLoaded("/fsr/view"));
  fsr_pressure_map::LoadFile call;
  call.request.path = file;
  ASSERT_TRUE(ros::service::call("calibration/load_calibration", call));
  EXPECT_TRUE(call.response.success) << call.response.message;
  rig.lieOn({10.0f});
  const auto calibrated = [](const PressureMap& m) { return !m.flags.empty() && m.state == m.STATE_OK; };
  EXPECT_EQ(rig.mapWhen(500, calibrated).pressure[5], test_support::knownPressure(5, 1, 500));

  sensor_msgs::PointCloud2::ConstPtr points;
  ros::NodeHandle handle;
  const ros::Subscriber eye = handle.subscribe<sensor_msgs::PointCloud2>(
      "points", 10, [&](const sensor_msgs::PointCloud2::ConstPtr& message) { points = message; });
  EXPECT_TRUE(CalibrationRig::waitFor([&] {
    rig.publishScan(500);
    return points != nullptr;
  }));
  std::filesystem::remove(file);
}

TEST(CalibrationNodelet, EndsAWaitingTareWhenItIsUnloaded) {
  const auto tare = [] {
    std_srvs::Trigger call;
    return ros::service::call("calibration/tare", call) ? call.response.message : "no reply";
  };
  std::future<std::string> reply = std::async(std::launch::async, tare);
  nodelet::NodeletUnload unload;
  unload.request.name = "/fsr/calibration";
  ASSERT_TRUE(ros::service::call("manager/unload_nodelet", unload));
  EXPECT_TRUE(unload.response.success);
  EXPECT_EQ(reply.wait_for(std::chrono::seconds(30)), std::future_status::ready);
  EXPECT_FALSE(isLoaded("/fsr/calibration"));
  EXPECT_TRUE(isLoaded("/fsr/view")) << "the manager goes on";
}

}  // namespace
