#include <iostream>

#include "ros/tools/plan_session_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("plan_session",
                                [&] { return fsr_ros::planSessionTool(argc, argv, std::cout); });
}
