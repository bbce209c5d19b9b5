#include <ros/ros.h>

#include "ros/live/limb_server.h"
#include "ros/live/parameters.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "limb");
  return fsr_ros::runNode([] {
    const fsr_ros::LimbServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
