#include <ros/ros.h>

#include "fsr_pressure_map/ros/parameters.h"
#include "fsr_pressure_map/ros/view_server.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "view");
  return fsr_ros::runNode([] {
    const fsr_ros::ViewServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
