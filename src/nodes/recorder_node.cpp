#include <ros/ros.h>

#include <csignal>

#include "ros/live/parameters.h"
#include "ros/recording/recorder.h"

namespace {

// ROS closes on SIGINT alone. kill and a closed terminal must not leave a bag without its index. A signal
// that is ignored, as under nohup, stays so.
void closeOn(int signal) {
  if (std::signal(signal, [](int) { ros::requestShutdown(); }) == SIG_IGN) std::signal(signal, SIG_IGN);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "record");
  bool failed = false;
  const int status = fsr_ros::runNode([&] {
    fsr_ros::Recorder recorder(ros::NodeHandle{}, ros::NodeHandle{"~"});
    closeOn(SIGTERM);
    closeOn(SIGHUP);
    ros::spin();
    recorder.finish();
    failed = recorder.failed();
  });
  return failed ? 1 : status;
}
