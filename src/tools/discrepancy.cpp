#include <iostream>

#include "fsr_pressure_map/ros/discrepancy_tool.h"
#include "fsr_pressure_map/settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::runTool("discrepancy", [&] { return fsr_ros::discrepancyTool(argc, argv, std::cout); });
}
