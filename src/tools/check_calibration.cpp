#include <iostream>

#include "ros/tools/check_calibration_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("check_calibration",
                                [&] { return fsr_ros::checkCalibrationTool(argc, argv, std::cout); });
}
