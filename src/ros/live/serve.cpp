#include "ros/live/serve.h"

#include <ros/callback_queue.h>
#include <std_srvs/Trigger.h>

#include "settings/foreign_error.h"

namespace fsr_ros {

namespace {

constexpr double kRetryPeriod = 1;  // [s]

}  // namespace

ros::ServiceServer advertiseTrigger(ros::NodeHandle& node, const std::string& name,
                                    const std::function<std::string()>& action) {
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;
  return node.advertiseService<Request, Response>(
      name, [action](Request&, Response& response) { return answer(response, action); });
}

bool makeUntilRight(const std::function<void()>& make, const std::function<void(const std::string&)>& say) {
  while (ros::ok()) {
    try {
      fsr::settings::inSentences(make);
      return true;
    } catch (const fsr::settings::InputError& error) {
      say(error.what());
    }
    const ros::WallTime again = ros::WallTime::now() + ros::WallDuration(kRetryPeriod);
    while (ros::ok() && ros::WallTime::now() < again)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kRetryPeriod / 10));
  }
  return false;
}

}  // namespace fsr_ros
