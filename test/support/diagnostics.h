#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <map>
#include <string>

#include "support/ros_listener.h"

namespace test_support {

/// The last status of every part of /diagnostics since the start.
class Diagnostics {
 public:
  Diagnostics() {
    const auto keep = [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
      for (const auto& status : array->status) last_[status.name] = status;
    };
    subscriber_ = ros::NodeHandle().subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1000, keep);
  }

  bool says(const std::string& name, const std::string& part) {
    return last_[name].message.find(part) != std::string::npos;
  }
  bool says(const std::string& name, int level, const std::string& part) {
    return last_[name].level == level && says(name, part);
  }
  /// The value of the key `key` of the part `name`; empty if there is none.
  std::string valueOf(const std::string& name, const std::string& key) {
    for (const auto& pair : last_[name].values) {
      if (pair.key == key) return pair.value;
    }
    return "";
  }
  /// Waits until the message of `name` contains `part` at `level`; returns `part`, or the last message if it
  /// never does.
  std::string await(const std::string& name, int level, const std::string& part) {
    const auto told = [&] { return says(name, level, part); };
    return test_support::await(told) ? part : last_[name].message;
  }
  /// Waits until `driver` has opened its port, with or without bytes.
  bool awaitOpenPort(const std::string& driver) {
    const std::string link = driver + ": link";
    return test_support::await([&] { return says(link, "reading") || says(link, "has sent nothing for"); });
  }

 private:
  ros::Subscriber subscriber_;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> last_;
};

}  // namespace test_support
