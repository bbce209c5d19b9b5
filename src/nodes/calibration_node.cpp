#include <ros/ros.h>

#include "ros/live/calibration_server.h"
#include "ros/live/parameters.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "calibration");
  return fsr_ros::runNode([] {
    const fsr_ros::CalibrationServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
