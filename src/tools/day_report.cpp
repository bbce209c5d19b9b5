#include <iostream>

#include "ros/tools/day_report_tool.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  return fsr::settings::runTool("day_report", [&] { return fsr_ros::dayReportTool(argc, argv, std::cout); });
}
