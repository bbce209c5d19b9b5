#include <ros/ros.h>

#include <csignal>

#include "ros/live/parameters.h"
#include "ros/recording/conduct_server.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "conduct");
  bool closed = true;
  const int status = fsr_ros::runNode([&] {
    const auto server = fsr_ros::waitForSession(ros::NodeHandle{}, ros::NodeHandle{"~"});
    if (server == nullptr) return;
    // As in the recorder: a bag gets its index. A signal that is ignored stays so.
    for (const int signal : {SIGTERM, SIGHUP}) {
      if (std::signal(signal, [](int) { ros::requestShutdown(); }) == SIG_IGN) std::signal(signal, SIG_IGN);
    }
    ros::spin();
    closed = server->finish();
  });
  return closed ? status : 1;
}
