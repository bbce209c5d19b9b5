#include <gtest/gtest.h>
#include <ros/ros.h>

#include "support/tests_of_node.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "ros_node_test");  // the launch file gives the name
  const ros::NodeHandle keep_alive;
  return test_support::runTestsOfThisNode();
}
