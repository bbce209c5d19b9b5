#include <ros/ros.h>

#include "fsr_pressure_map/ros/parameters.h"
#include "fsr_pressure_map/ros/training_server.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "training");
  return fsr_ros::runNode([] {
    const fsr_ros::TrainingServer server(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::MultiThreadedSpinner(2).spin();  // gathering goes on while ~train works
  });
}
