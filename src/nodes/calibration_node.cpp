#include "ros/live/calibration_server.h"
#include "ros/live/serve.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "calibration");
  return fsr_ros::serve<fsr_ros::CalibrationServer>();
}
