#include <iostream>

#include "ros/tools/train_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("train", [&] { return fsr_ros::trainTool(argc, argv, std::cout); });
}
