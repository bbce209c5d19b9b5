#include <iostream>

#include "ros/tools/calibration_history_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("calibration_history",
                                [&] { return fsr_ros::calibrationHistoryTool(argc, argv, std::cout); });
}
