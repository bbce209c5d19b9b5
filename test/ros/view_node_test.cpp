#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <fsr_pressure_map/SetAlarm.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <functional>

#include "support/ros_listener.h"

namespace {

using fsr_pressure_map::PressureMap;
using fsr_pressure_map::SurfaceCurvature;
using sensor_msgs::PointCloud2;

/// Publishes the map and the curvature that the view node needs.
class View : public testing::Test {
 protected:
  void SetUp() override {
    maps = handle.advertise<PressureMap>("pressure_map", 10);
    curvature = handle.advertise<SurfaceCurvature>("curvature", 10, true);
  }

  /// Publishes maps until `done`, or for 30 s.
  bool publishUntil(const std::function<bool()>& done) {
    return test_support::await([&] {
      if (!done()) maps.publish(map());
      return done();
    });
  }

  static PressureMap map() {
    PressureMap message;
    message.header.frame_id = "left_sheet";
    message.header.stamp = ros::Time(1234, 5);
    message.rows = 3;
    message.columns = 5;
    message.pitch_x = message.pitch_y = 0.010f;
    for (int i = 0; i < 15; ++i) message.pressure.push_back(1000.0f * float(i));
    message.deviation.assign(15, 100.0f);
    message.flags.assign(15, 0);
    message.flags[7] = PressureMap::FLAG_HISTORY_SHORT;  // changes no number and no alarm
    return message;
  }

  void bend(float x, std::size_t values) {
    SurfaceCurvature message;
    message.x.assign(values, x);
    curvature.publish(message);
  }

  ros::Subscriber look() {
    return handle.subscribe<PointCloud2>("points", 10, [this](const PointCloud2::ConstPtr& m) { cloud = m; });
  }

  static bool setAlarm(double threshold, const std::string& region = "") {
    fsr_pressure_map::SetAlarm alarm;
    alarm.request.threshold = threshold;
    alarm.request.region = region;
    EXPECT_TRUE(ros::service::call("view/set_alarm", alarm));
    EXPECT_FALSE(alarm.response.message.empty());
    return alarm.response.success;
  }

  float heightOfCorner() const { return *sensor_msgs::PointCloud2ConstIterator<float>(*cloud, "z"); }

  ros::NodeHandle handle;
  ros::Publisher maps;
  ros::Publisher curvature;
  PointCloud2::ConstPtr cloud;
};

TEST_F(View, ShowsTheMapInTheFrameOfItsScan) {
  const ros::Subscriber eyes = look();
  ASSERT_TRUE(publishUntil([&] { return cloud != nullptr; }));
  EXPECT_EQ(cloud->header.frame_id, "left_sheet");
  EXPECT_EQ(cloud->header.stamp, ros::Time(1234, 5));
  EXPECT_EQ(cloud->height, 3u);
  EXPECT_EQ(cloud->width, 5u);
  sensor_msgs::PointCloud2ConstIterator<float> intensity(*cloud, "intensity");
  EXPECT_EQ(intensity[14 * int(cloud->point_step / sizeof(float))], 14000.0f);
}

TEST_F(View, BendsTheSheetWithTheSurface) {
  const ros::Subscriber eyes = look();
  bend(20.0f, 1);
  const float height =
      (std::cos(20.0f * 0.020f) - 1) / 20.0f;  // cylinder of 5 cm radius, 2 cm from its top line
  EXPECT_TRUE(publishUntil([&] { return cloud && std::abs(heightOfCorner() - height) < 1e-7f; }));
  bend(0.0f, 15);
  EXPECT_TRUE(publishUntil([&] { return heightOfCorner() == 0.0f; }));
}

TEST_F(View, SurvivesASurfaceOfAnotherMatrix) {
  const ros::Subscriber eyes = look();
  bend(20.0f, 70);
  for (int i = 0; i < 10; ++i) {
    maps.publish(map());
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
  }
  bend(10.0f, 1);
  cloud.reset();
  EXPECT_TRUE(publishUntil([&] { return cloud && heightOfCorner() < -1e-3f; }));
}

TEST_F(View, DrawsTheSheetWithMarksCentrePeakAndLegend) {
  visualization_msgs::MarkerArray::ConstPtr array;
  const ros::Subscriber eyes = handle.subscribe<visualization_msgs::MarkerArray>(
      "surface", 10, [&](const visualization_msgs::MarkerArray::ConstPtr& m) { array = m; });
  ASSERT_TRUE(publishUntil([&] { return array != nullptr; }));
  ASSERT_EQ(array->markers.size(), 5u);
  const auto& sheet = array->markers[0];
  EXPECT_EQ(sheet.header.frame_id, "left_sheet");
  EXPECT_EQ(sheet.points.size(), 15u * 9 * 6);
  EXPECT_EQ(sheet.colors.size(), sheet.points.size());
  EXPECT_NEAR(array->markers[3].pose.position.x, 0.020,
              1e-3);  // the peak: row 2, column 4, whatever the curvature
  EXPECT_NEAR(array->markers[3].pose.position.y, 0.010, 1e-3);
  for (const char* words : {"105 mmHg", "history not settled on 7 % of taxels"}) {
    EXPECT_NE(array->markers[4].text.find(words), std::string::npos) << array->markers[4].text;
  }
}

TEST_F(View, PaintsAnImageForAnyViewer) {
  sensor_msgs::Image::ConstPtr image;
  const ros::Subscriber eyes = handle.subscribe<sensor_msgs::Image>(
      "image", 10, [&](const sensor_msgs::Image::ConstPtr& m) { image = m; });
  ASSERT_TRUE(publishUntil([&] { return image != nullptr; }));
  EXPECT_EQ(image->encoding, "rgb8");
  EXPECT_EQ(image->header.stamp, ros::Time(1234, 5));
  EXPECT_EQ(image->data.size(), std::size_t(image->height) * image->width * 3);
  // The maps stop: grey, the same value in all three channels, where there was a colour.
  const auto isGrey = [&] {
    const std::size_t middle = 3 * (image->height / 2 * image->width + image->width / 2 + 40);
    return image->data[middle] == 128 && image->data[middle + 1] == 128 && image->data[middle + 2] == 128;
  };
  EXPECT_FALSE(isGrey());
  EXPECT_TRUE(test_support::await(isGrey));
}

// 10, 11, 12, 13, 14 kPa are in contact (10 kPa and more), 1e-4 m^2 each: 60 kPa x 1e-4 m^2 = 6 N.
TEST_F(View, CountsAndThenSaysUnknownWhenMapsStop) {
  using fsr_pressure_map::PressureStatistics;
  using fsr_pressure_map::PressureStatisticsArray;
  PressureStatisticsArray::ConstPtr array;
  const ros::Subscriber ears = handle.subscribe<PressureStatisticsArray>(
      "statistics", 10, [&](const PressureStatisticsArray::ConstPtr& m) { array = m; });
  geometry_msgs::PointStamped::ConstPtr centre;
  const ros::Subscriber eyes = handle.subscribe<geometry_msgs::PointStamped>(
      "centre_of_pressure", 10, [&](const geometry_msgs::PointStamped::ConstPtr& m) { centre = m; });
  ASSERT_TRUE(publishUntil([&] { return array && centre && array->regions.at(0).peak > 0; }));
  const PressureStatistics whole = array->regions.at(0);
  EXPECT_NEAR(whole.peak, 14e3, 1e-3);
  EXPECT_EQ(whole.peak_row, 2);
  EXPECT_EQ(whole.peak_column, 4);
  EXPECT_NEAR(whole.force, 6.0, 1e-3);
  EXPECT_NEAR(whole.contact_area, 5e-4, 1e-8);
  EXPECT_EQ(whole.alarm, 3) << "no threshold is set, so it must not be OK";
  EXPECT_TRUE(setAlarm(1e6));
  EXPECT_TRUE(publishUntil([&] { return array->regions.at(0).alarm == PressureStatistics::OK; }));
  EXPECT_NEAR(centre->point.y, 0.010, 1e-6);  // all of row 2
  const auto unknown = [&] { return array->regions.at(0).alarm == PressureStatistics::UNKNOWN; };
  EXPECT_TRUE(test_support::await(unknown));
  EXPECT_TRUE(std::isnan(array->regions.at(0).peak));
  EXPECT_TRUE(setAlarm(0));
}

TEST_F(View, RaisesAnAlarmAsAnEventThoughNobodyLooks) {
  std::vector<fsr_pressure_map::Event> events;
  const ros::Subscriber ears = handle.subscribe<fsr_pressure_map::Event>(
      "events", 10, [&](const fsr_pressure_map::Event::ConstPtr& event) { events.push_back(*event); });
  ASSERT_TRUE(publishUntil([&] { return ears.getNumPublishers() > 0; }));
  EXPECT_FALSE(setAlarm(10e3, "knee")) << "there is no such region";
  EXPECT_FALSE(setAlarm(-1));
  ASSERT_TRUE(setAlarm(13e3));
  ASSERT_TRUE(publishUntil([&] { return !events.empty(); }));
  EXPECT_EQ(events[0].kind, "note");
  EXPECT_EQ(events[0].label, "ALARM: the whole matrix, peak 105 mmHg");
  EXPECT_EQ(events[0].header.stamp, ros::Time(1234, 5));
  ASSERT_TRUE(setAlarm(100e3));
  ASSERT_TRUE(publishUntil([&] { return events.size() > 1; }));
  EXPECT_EQ(events[1].label, "alarm ended: the whole matrix");
  EXPECT_TRUE(setAlarm(0));
}

TEST_F(View, ReceivesMapsOnlyWhileSomebodyLooks) {
  {
    const ros::Subscriber eyes = look();
    EXPECT_TRUE(publishUntil([&] { return maps.getNumSubscribers() == 1; }));
  }
  EXPECT_TRUE(publishUntil([&] { return maps.getNumSubscribers() == 0; }));
}

}  // namespace
