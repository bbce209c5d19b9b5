#include <gtest/gtest.h>
#include <ros/ros.h>

#include <QApplication>
#include <cstdio>
#include <cstdlib>

#include "support/tests_of_node.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "ros_rviz_test");  // the launch file gives the name
  const QApplication application(argc, argv);
  const ros::NodeHandle keep_alive;
  const int status = test_support::runTestsOfThisNode();
  std::fflush(nullptr);
  std::_Exit(
      status);  // rviz's static objects may be destroyed after the display server, so do not destroy them
}
