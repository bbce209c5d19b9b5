#include <iostream>

#include "ros/tools/study_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("study", [&] { return fsr_ros::studyTool(argc, argv, std::cout); });
}
