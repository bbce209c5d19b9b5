#include <ros/ros.h>

#include "fsr_pressure_map/ros/calibration_server.h"
#include "fsr_pressure_map/ros/parameters.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "calibration");
  return fsr_ros::runNode([] {
    const fsr_ros::CalibrationServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
