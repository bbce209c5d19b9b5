#include <ros/ros.h>

#include "ros/live/parameters.h"
#include "ros/recording/session_server.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "session");
  return fsr_ros::runNode([] {
    const fsr_ros::SessionServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
