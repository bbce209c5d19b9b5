#include <ros/ros.h>

#include "ros/live/parameters.h"
#include "ros/live/training_server.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "training");
  return fsr_ros::runNode([] {
    const fsr_ros::TrainingServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::MultiThreadedSpinner(2).spin();  // messages are collected while ~train runs
  });
}
