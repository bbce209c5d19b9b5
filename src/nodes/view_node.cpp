#include "ros/live/serve.h"
#include "ros/live/view_server.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "view");
  return fsr_ros::serve<fsr_ros::ViewServer>();
}
