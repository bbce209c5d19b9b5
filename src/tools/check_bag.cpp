#include <iostream>

#include "fsr_pressure_map/ros/check_bag_tool.h"
#include "fsr_pressure_map/settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::runTool("check_bag", [&] { return fsr_ros::checkBagTool(argc, argv, std::cout); });
}
