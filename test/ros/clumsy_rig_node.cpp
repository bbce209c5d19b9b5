// The emulated rig with an operator who makes the mistakes of the parameter `~mistakes`, NAME@STEP,...

#include <ros/ros.h>

#include "ros/live/parameters.h"
#include "ros/live/rig_emulator.h"
#include "support/clumsy_operator.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "rig_emulator");
  return fsr_ros::runNode([] {
    const ros::NodeHandle own("~");
    const auto rig = fsr_ros::makeRigEmulator(ros::NodeHandle{}, own, [&](const auto& person) {
      test_support::ClumsyOptions options;
      options.person = person;
      options.script = own.param<std::string>("mistakes", "");
      options.shelf = {"flat", "cylinder_5cm"};
      return std::make_shared<test_support::ClumsyOperator>(options);
    });
    ros::spin();
  });
}
