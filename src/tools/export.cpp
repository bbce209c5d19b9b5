#include <iostream>

#include "fsr_pressure_map/ros/export_tool.h"
#include "fsr_pressure_map/settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::runTool("export", [&] { return fsr_ros::exportTool(argc, argv, std::cout); });
}
