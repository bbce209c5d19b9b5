#pragma once

#include <string>

#include "ros/live/parameters.h"

namespace fsr_ros {

/// Path of a file in which a node keeps `what` from one run to the next: the parameter `name`, or, where it
/// is not set or empty (as in the launch files), a file of its own for each node: /fsr/calibration and "tare"
/// give
/// ${ROS_HOME}/fsr_pressure_map/fsr_calibration_tare.yaml. Throws fsr::InputError.
std::string ownFile(const Parameters& parameters, const std::string& name, const std::string& node,
                    const std::string& what);

}  // namespace fsr_ros
