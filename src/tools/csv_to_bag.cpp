#include <iostream>

#include "fsr_pressure_map/ros/csv_tool.h"
#include "fsr_pressure_map/settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::runTool("csv_to_bag", [&] { return fsr_ros::csvToBagTool(argc, argv, std::cout); });
}
