#include <ros/ros.h>

#include "ros/live/curvature_server.h"
#include "ros/live/parameters.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "curvature");
  return fsr_ros::runNode([] {
    const fsr_ros::CurvatureServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
