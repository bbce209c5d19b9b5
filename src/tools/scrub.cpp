#include <iostream>

#include "fsr_pressure_map/ros/scrub_tool.h"
#include "fsr_pressure_map/settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::runTool("scrub", [&] { return fsr_ros::scrubTool(argc, argv, std::cout); });
}
