#pragma once

#include <ros/console.h>
#include <ros/ros.h>

#include <functional>
#include <memory>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/parameters.h"
#include "settings/foreign_error.h"
#include "settings/printable.h"

namespace fsr_ros {

/// Advertises a service without arguments: `action` does it and returns a sentence, see answer().
ros::ServiceServer advertiseTrigger(ros::NodeHandle& node, const std::string& name,
                                    const std::function<std::string()>& action);

/// Calls `make` until it does not throw, once a second, because a file or parameter can be put right
/// meanwhile. `say` gets the sentence of each failure. Callbacks are called between two attempts. False where
/// ROS is shut down before.
bool makeUntilRight(const std::function<void()>& make, const std::function<void(const std::string&)>& say);

/// Runs the action of a service and puts its sentence into the reply. If the action throws an exception, the
/// reply has success = false and the reason; the call itself does not fail. Both are logged. Returns
/// true, the return value of the service callback.
template <typename Response, typename Action>
bool answer(Response& response, Action action) {
  try {
    response.message = fsr::settings::printable(fsr::settings::inSentences(action));
    response.success = true;
    ROS_INFO_STREAM(response.message);
  } catch (const fsr::settings::InputError& error) {
    response.message = fsr::settings::printable(error.what());
    response.success = false;
    ROS_WARN_STREAM(response.message);
  }
  return true;
}

}  // namespace fsr_ros
