#include "ros/driver/driver.h"
#include "ros/live/serve.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "driver");
  return fsr_ros::serve<fsr_ros::Driver>();
}
