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
  const auto loaded = test_support::call<nodelet::NodeletList>("manager/list").nodelets;
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
  fsr_pressure_map::LoadFile::Request request;
  request.path = file;
  const auto reply = test_support::call<fsr_pressure_map::LoadFile>("calibration/load_calibration", request);
  EXPECT_TRUE(reply.success) << reply.message;
  rig.lieOn({10.0f});
  const auto calibrated = [](const PressureMap& m) { return !m.flags.empty() && m.state == m.STATE_OK; };
  EXPECT_EQ(rig.mapWhen(500, calibrated).pressure[5], test_support::knownPressure(5, 1, 500));

  const test_support::Listener<sensor_msgs::PointCloud2> points("points");
  EXPECT_TRUE(test_support::await([&] {
    rig.publishScan(500);
    return !points.messages.empty();
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
