#include <ros/ros.h>

#include "fsr_pressure_map/ros/curvature_server.h"
#include "fsr_pressure_map/ros/parameters.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "curvature");
  return fsr_ros::runNode([] {
    const fsr_ros::CurvatureServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
