#include <ros/ros.h>

#include "ros/live/parameters.h"
#include "ros/live/recorder.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "record");
  bool failed = false;
  const int status = fsr_ros::runNode([&] {
    const fsr_ros::Recorder recorder(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
    failed = recorder.failed();
  });
  return failed ? 1 : status;
}
