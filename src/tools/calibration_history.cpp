#include <iostream>

#include "ros/tools/check_calibration_tool.h"
#include "settings/command_line.h"

// The earlier name of check_calibration DIR, for one version.
int main(int argc, char** argv) {
  return fsr::settings::runTool("calibration_history", [&] {
    return fsr_ros::checkInstead("calibration_history", {argv + 1, argv + argc}, std::cout);
  });
}
