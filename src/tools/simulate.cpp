#include <iostream>

#include "ros/tools/simulate_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("simulate", [&] { return fsr_ros::simulateTool(argc, argv, std::cout); });
}
