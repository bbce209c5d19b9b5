#include <ros/ros.h>

#include "fsr_pressure_map/ros/limb_server.h"
#include "fsr_pressure_map/ros/parameters.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "limb");
  return fsr_ros::runNode([] {
    const fsr_ros::LimbServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
