#pragma once

#include <ros/console.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/foreign_error.h"
#include "settings/printable.h"

namespace fsr_ros {

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
