#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <cmath>
#include <functional>

namespace {

using fsr_pressure_map::PressureMap;
using fsr_pressure_map::SurfaceCurvature;
using sensor_msgs::PointCloud2;

/// The view node's surroundings: a map and a curvature that others would publish.
class View : public testing::Test {
 protected:
  void SetUp() override {
    maps = handle.advertise<PressureMap>("pressure_map", 10);
    curvature = handle.advertise<SurfaceCurvature>("curvature", 10, true);
  }

  /// Publishes a map now and then until `done`, or for 30 s.
  bool publishUntil(const std::function<bool()>& done) {
    const ros::WallTime give_up = ros::WallTime::now() + ros::WallDuration(30);
    while (!done() && ros::WallTime::now() < give_up) {
      maps.publish(map());
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
    }
    return done();
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
  const float height = (std::cos(20.0f * 0.020f) - 1) / 20.0f;  // cylinder of 5 cm, 2 cm from its line
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

TEST_F(View, ReceivesMapsOnlyWhileSomebodyLooks) {
  {
    const ros::Subscriber eyes = look();
    EXPECT_TRUE(publishUntil([&] { return maps.getNumSubscribers() == 1; }));
  }
  EXPECT_TRUE(publishUntil([&] { return maps.getNumSubscribers() == 0; }));
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "view_node_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
