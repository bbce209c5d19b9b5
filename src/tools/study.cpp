#include <iostream>

#include "fsr_pressure_map/ros/study_tool.h"
#include "fsr_pressure_map/settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::runTool("study", [&] { return fsr_ros::studyTool(argc, argv, std::cout); });
}
