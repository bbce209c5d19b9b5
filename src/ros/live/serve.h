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
