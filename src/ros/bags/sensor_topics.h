#pragma once

#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ros/bags/bag_walk.h"

namespace fsr_ros {

/// Runs `read` on the bag's file. Throws fsr::InputError, one sentence that names the file and what would be
/// right, if the file does not exist or is empty, or if `read` throws an exception, e.g. of rosbag or of
/// ros::serialization.
void tellingOfDamage(const std::string& path, const std::function<void()>& read);

/// Checks the structure of a bag (requireSoundBag, with `progress`), opens it and runs `use` on it. Throws
/// likewise. rosbag keeps an index of every message in memory: a sixth of a bag of scans.
void withSoundBag(const std::string& path, const std::function<void(const rosbag::Bag&)>& use,
                  const BagWalk::ReadProgress& progress = {});

/// Calls take(message) for the messages of these topics in the order of their reception, until it returns
/// false. No topics = all. `progress`: called now and then with the share that is done.
void forEachMessage(const rosbag::Bag& bag, const std::vector<std::string>& topics,
                    const std::function<bool(const rosbag::MessageInstance& message)>& take,
                    const BagWalk::ReadProgress& progress = {});

/// Message type of each topic that has a message.
std::map<std::string, std::string> typesIn(const rosbag::Bag& bag);
/// Message type of each topic in the index.
std::map<std::string, std::string> typesOf(const BagWalk& bag);

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

  /// Namespaces of the sensors in a bag, found by `marks`. One inside another that has the first mark, e.g.
  /// fsr/flat_only in fsr, is no sensor without that mark itself.
  static std::set<std::string> namespaces(const Types& types, const std::vector<Mark>& marks);

  /// The name of a topic as the bag spells it; "" = the bag does not have it.
  std::string find(const std::string& base) const;
  /// The same, or else the only topic of this name and type in the bag, which then is that of all sheets.
  std::string findShared(const std::string& base, const std::string& type) const;
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
