#pragma once

#include <ros/console.h>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

/// Runs what a service asks for and puts its sentence into the reply, or the reason why not: an
/// fsr::InputError is a refusal, not a failed call. Both are logged. Returns true, as a service
/// callback does whose reply was made.
template <typename Response, typename Action>
bool answer(Response& response, Action action) {
  try {
    response.message = action();
    response.success = true;
    ROS_INFO_STREAM(response.message);
  } catch (const fsr::settings::InputError& error) {
    response.message = error.what();
    response.success = false;
    ROS_WARN_STREAM(response.message);
  }
  return true;
}

}  // namespace fsr_ros
