#include <ros/ros.h>

#include "ros/live/parameters.h"
#include "ros/live/rig_emulator.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "rig_emulator");
  return fsr_ros::runNode([] {
    const fsr_ros::RigEmulator rig(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
