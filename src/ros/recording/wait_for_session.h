#pragma once

#include <ros/node_handle.h>

#include <memory>

#include "ros/recording/conduct_server.h"

namespace fsr_ros {

/// Starts the conductor. While it cannot start, e.g. because the plan is missing or has a mistake, it says
/// why in the terminal and on `instruction`, and tries again each second: a file that is put right is taken
/// up. Null where ROS is shut down before.
std::unique_ptr<ConductServer> waitForSession(const ros::NodeHandle& handle,
                                              const ros::NodeHandle& private_handle);

}  // namespace fsr_ros
