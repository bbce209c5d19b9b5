#include "ros/live/serve.h"
#include "ros/recording/session_server.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "session");
  return fsr_ros::serve<fsr_ros::SessionServer>();
}
