#include <iostream>

#include "fsr_pressure_map/ros/simulate_tool.h"
#include "fsr_pressure_map/settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::runTool("simulate", [&] { return fsr_ros::simulateTool(argc, argv, std::cout); });
}
