#include <iostream>

#include "ros/tools/export_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("export", [&] { return fsr_ros::exportTool(argc, argv, std::cout); });
}
