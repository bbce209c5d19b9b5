#include <ros/ros.h>

#include "ros/driver/driver.h"
#include "ros/live/parameters.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "driver");
  return fsr_ros::runNode([] {
    const fsr_ros::Driver driver(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
