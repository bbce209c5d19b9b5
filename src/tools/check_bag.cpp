#include <iostream>

#include "ros/tools/check_bag_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("check_bag", [&] { return fsr_ros::checkBagTool(argc, argv, std::cout); });
}
