#include "ros/live/curvature_server.h"
#include "ros/live/serve.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "curvature");
  return fsr_ros::serve<fsr_ros::CurvatureServer>();
}
