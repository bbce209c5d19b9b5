#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include "support/diagnostics.h"
#include "support/ros_listener.h"

namespace {

using fsr_pressure_map::PressureStatistics;
using fsr_pressure_map::PressureStatisticsArray;

/// A sheet with 10 N on 4 cm^2.
PressureStatisticsArray sheet(std::uint8_t alarm) {
  PressureStatistics region;
  region.peak = region.mean = 25e3;
  region.contact_area = 4e-4;
  region.total_area = 7e-3;
  region.force = 10;
  region.alarm = alarm;
  PressureStatisticsArray array;
  array.regions.push_back(region);
  return array;
}

TEST(Limb, SumsItsSheetsAndReportsASilentOne) {
  ros::NodeHandle handle;
  test_support::Listener<PressureStatisticsArray> ears("limb_statistics");
  ros::Publisher left = handle.advertise<PressureStatisticsArray>("left/statistics", 10);
  ros::Publisher right = handle.advertise<PressureStatisticsArray>("right/statistics", 10);
  ASSERT_TRUE(ears.connected());
  const auto last = [&] {
    return ears.messages.empty() ? PressureStatistics() : ears.messages.back()->regions[0];
  };
  ASSERT_TRUE(test_support::await([&] {
    left.publish(sheet(PressureStatistics::OK));
    right.publish(sheet(PressureStatistics::OK));
    return last().force == 20.0 && last().alarm == PressureStatistics::OK;
  }));
  EXPECT_NEAR(last().contact_area, 8e-4, 1e-12);
  EXPECT_NEAR(last().mean, 25e3, 1e-6);
  ASSERT_TRUE(test_support::await([&] {
    left.publish(sheet(PressureStatistics::OK));  // the right sheet sends nothing from here on
    return last().force == 10.0 && last().alarm == PressureStatistics::UNKNOWN;
  }));
  ASSERT_TRUE(test_support::await([&] {
    left.publish(sheet(PressureStatistics::ALARM));
    return last().alarm == PressureStatistics::ALARM;
  }));
}

TEST(Limb, NamesTwoSheetsWhoseBoardsHaveOneSerialNumber) {
  ros::NodeHandle handle;
  test_support::Diagnostics diagnostics;
  const auto info = [](const std::string& serial) {
    fsr_pressure_map::MatrixInfo message;
    message.serial = serial;
    return message;
  };
  ros::Publisher left = handle.advertise<fsr_pressure_map::MatrixInfo>("left/matrix_info", 1, true);
  ros::Publisher right = handle.advertise<fsr_pressure_map::MatrixInfo>("right/matrix_info", 1, true);
  const auto says = [&](const std::string& words, int level) {
    return diagnostics.await("limb: sheets", level, words) == words;
  };
  left.publish(info("A1"));
  right.publish(info("A1"));
  EXPECT_TRUE(says("/left and /right have the same serial number, A1: give each sheet the serial_port", 2));
  right.publish(info("B2"));
  EXPECT_TRUE(says("no statistics come from /left /right", 1));
}

}  // namespace
