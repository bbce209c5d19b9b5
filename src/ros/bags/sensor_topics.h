#pragma once

#include <rosbag/bag.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace fsr_ros {

/// Runs `read` on the bag's file. Throws fsr::InputError, one sentence that names the file and what would be
/// right, if the file does not exist or is empty, or if `read` throws an exception, e.g. of rosbag or of
/// ros::serialization.
void tellingOfDamage(const std::string& path, const std::function<void()>& read);

/// Checks the structure of a bag (requireSoundBag), opens it and runs `use` on it. Throws likewise.
void withSoundBag(const std::string& path, const std::function<void(const rosbag::Bag&)>& use);

/// The topics of one sensor in a bag: the topics of one namespace, found by their base names.
class SensorTopics {
 public:
  using Types = std::map<std::string, std::string>;  ///< message type of each topic

  /// Base name and type of a topic by which the namespace of a sensor is found.
  struct Mark {
    std::string base, type;
  };

  /// `topics`: namespace of the sensor; empty = the only namespace in the bag with a topic of `marks`. Throws
  /// fsr::InputError that lists the topics or sensors of the bag.
  SensorTopics(Types types, const std::string& topics, const std::vector<Mark>& marks);

  /// The name of a topic as the bag spells it; "" = the bag does not have it.
  std::string find(const std::string& base) const;
  /// Whether the bag has a topic of this full name.
  bool has(const std::string& topic) const { return types_.count(topic) > 0; }
  /// All topics of the bag, "a, b".
  std::string list() const;
  /// Throws fsr::InputError if the topic is of another type.
  void requireType(const std::string& topic, const std::string& type) const;

 private:
  std::string findNamespace(const std::vector<Mark>& marks) const;

  Types types_;
  std::string prefix_;  // without slashes at its ends
};

}  // namespace fsr_ros
