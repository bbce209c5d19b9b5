#include <ros/ros.h>

#include "fsr_pressure_map/ros/parameters.h"
#include "fsr_pressure_map/ros/rig_emulator.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "rig_emulator");
  return fsr_ros::runNode([] {
    const fsr_ros::RigEmulator rig(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}
