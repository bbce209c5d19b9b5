#pragma once

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <string>
#include <vector>

namespace test_support {

/// Serves callbacks until `condition` returns true. Returns false after 30 s of wall time, which working code
/// never needs.
template <typename Condition>
bool await(Condition condition) {
  const ros::WallTime give_up = ros::WallTime::now() + ros::WallDuration(30);
  while (!condition()) {
    if (ros::WallTime::now() > give_up) return false;
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return true;
}

/// The response of a service, which is waited for.
template <typename Service>
typename Service::Response call(const std::string& name, typename Service::Request request = {}) {
  typename Service::Response response;
  EXPECT_TRUE(ros::service::waitForService(name) && ros::service::call(name, request, response)) << name;
  return response;
}

/// Keeps all messages of a topic.
template <typename Message>
class Listener {
 public:
  explicit Listener(const std::string& topic) {
    const auto keep = [this](const typename Message::ConstPtr& message) { messages.push_back(message); };
    subscriber_ = ros::NodeHandle().subscribe<Message>(topic, 10000, keep);
  }

  std::vector<typename Message::ConstPtr> messages;

  /// Waits for the publisher, so that no later message is missed.
  bool connected() const {
    return await([this] { return subscriber_.getNumPublishers() > 0; });
  }
  bool has(std::size_t count) const {
    return await([&] { return messages.size() >= count; });
  }

 private:
  ros::Subscriber subscriber_;
};

}  // namespace test_support
