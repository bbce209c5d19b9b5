#include <iostream>

#include "ros/tools/discrepancy_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("discrepancy",
                                [&] { return fsr_ros::discrepancyTool(argc, argv, std::cout); });
}
