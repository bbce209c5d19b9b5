#include <iostream>

#include "ros/tools/scrub_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("scrub", [&] { return fsr_ros::scrubTool(argc, argv, std::cout); });
}
