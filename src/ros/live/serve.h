#pragma once

#include <ros/ros.h>

#include <functional>
#include <memory>
#include <string>

#include "ros/live/parameters.h"

namespace fsr_ros {

/// Calls `make` until it does not throw, once a second, because a file or parameter can be put right
/// meanwhile. `say` gets the sentence of each failure. Callbacks are called between two attempts. False where
/// ROS is shut down before.
bool makeUntilRight(const std::function<void()>& make, const std::function<void(const std::string&)>& say);

/// The main part of a node that roslaunch starts again when it ends: makes its server, and spins. A wrong
/// setting does not end the node where roslaunch started it, which would fill the screen each second: it is
/// said once, and the node waits until it is put right. A node that was started alone ends with status 2.
template <typename Server>
int serve() {
  return runNode([] {
    const ros::NodeHandle handle, private_handle("~");
    std::unique_ptr<Server> server;
    const auto make = [&] { server = std::make_unique<Server>(handle, private_handle); };
    std::string said;
    const auto say = [&](const std::string& sentence) {
      if (said != sentence)
        ROS_FATAL_STREAM(sentence << " (" << ros::this_node::getName() << " tries again each second)");
      said = sentence;
    };
    if (!private_handle.hasParam("launched")) make();
    if (server || makeUntilRight(make, say)) ros::spin();
  });
}

}  // namespace fsr_ros
