#include <iostream>

#include "fsr_pressure_map/ros/train_tool.h"
#include "fsr_pressure_map/settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::runTool("train", [&] { return fsr_ros::trainTool(argc, argv, std::cout); });
}
