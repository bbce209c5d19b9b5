#include "ros/recording/wait_for_session.h"

#include <fsr_pressure_map/Instruction.h>
#include <ros/console.h>

#include "ros/live/serve.h"

namespace fsr_ros {

std::unique_ptr<ConductServer> waitForSession(const ros::NodeHandle& handle,
                                              const ros::NodeHandle& private_handle) {
  ros::NodeHandle own(handle);
  ros::Publisher instruction;
  std::string said;
  std::unique_ptr<ConductServer> server;
  const auto make = [&] { server = std::make_unique<ConductServer>(handle, private_handle); };
  makeUntilRight(make, [&](const std::string& sentence) {
    if (said != sentence) ROS_ERROR_STREAM("the session cannot begin: " << sentence);
    said = sentence;
    if (!instruction) instruction = own.advertise<fsr_pressure_map::Instruction>("instruction", 1, true);
    fsr_pressure_map::Instruction message;
    message.header.stamp = ros::Time::now();
    message.kind = fsr_pressure_map::Instruction::BREAK;
    message.text = "The session cannot begin. Put right what is said below; it is tried again each second.";
    message.remark = sentence;
    instruction.publish(message);
  });
  return server;
}

}  // namespace fsr_ros
