// main() of the tests that need nothing before them but ROS.

#include <gtest/gtest.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test");  // the launch file gives the name
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
