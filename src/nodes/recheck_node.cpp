#include <ros/ros.h>

#include <iostream>

#include "ros/live/parameters.h"
#include "ros/recording/rechecker.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "recheck");
  bool done = false;
  const int status = fsr_ros::runNode([&] {
    fsr_ros::Rechecker rechecker(ros::NodeHandle{}, ros::NodeHandle{"~"});
    done = rechecker.run(std::cout);
  });
  return status != 0 || done ? status : 1;
}
