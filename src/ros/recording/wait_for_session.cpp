#include "ros/recording/wait_for_session.h"

#include <fsr_pressure_map/Instruction.h>
#include <ros/callback_queue.h>
#include <ros/console.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/foreign_error.h"

namespace fsr_ros {

namespace {

constexpr double kAgain = 1;  // [s]

}  // namespace

std::unique_ptr<ConductServer> waitForSession(const ros::NodeHandle& handle,
                                              const ros::NodeHandle& private_handle) {
  ros::NodeHandle own(handle);
  ros::Publisher instruction;
  std::string said;
  while (ros::ok()) {
    try {
      std::unique_ptr<ConductServer> server;
      fsr::settings::inSentences([&] { server = std::make_unique<ConductServer>(handle, private_handle); });
      return server;
    } catch (const fsr::settings::InputError& error) {
      if (said != error.what()) ROS_ERROR_STREAM("the session cannot begin: " << error.what());
      said = error.what();
      if (!instruction) instruction = own.advertise<fsr_pressure_map::Instruction>("instruction", 1, true);
      fsr_pressure_map::Instruction message;
      message.header.stamp = ros::Time::now();
      message.kind = fsr_pressure_map::Instruction::BREAK;
      message.text = "The session cannot begin. Put right what is said below; it is tried again each second.";
      message.remark = error.what();
      instruction.publish(message);
    }
    // Subscribers that connect get what was said.
    const ros::WallTime again = ros::WallTime::now() + ros::WallDuration(kAgain);
    while (ros::ok() && ros::WallTime::now() < again)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kAgain / 10));
  }
  return nullptr;
}

}  // namespace fsr_ros
