#include <ros/ros.h>

#include "ros/live/parameters.h"
#include "ros/live/view_server.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "view");
  return fsr_ros::runNode([] {
    const fsr_ros::ViewServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
