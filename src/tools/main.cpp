// CMake makes an executable of this file for each tool, and defines FSR_TOOL_NAME, its name, and FSR_TOOL,
// its function.
#include <iostream>

#include "ros/tools/tools.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool(FSR_TOOL_NAME, [&] { return fsr_ros::FSR_TOOL(argc, argv, std::cout); });
}
