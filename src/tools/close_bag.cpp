#include <iostream>

#include "ros/tools/close_bag_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("close_bag", [&] { return fsr_ros::closeBagTool(argc, argv, std::cout); });
}
