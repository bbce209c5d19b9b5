#include <iostream>

#include "ros/tools/csv_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("csv_to_bag", [&] { return fsr_ros::csvToBagTool(argc, argv, std::cout); });
}
