#pragma once

#include <rosbag/bag.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace fsr_ros {

/// Runs `read` on the bag's file. Throws fsr::InputError, one sentence that names the file and what would be
/// right: no such file, empty, and where `read` throws a rosbag::BagException or fsr::InputError or meets a
/// message that is cut short.
void tellingOfDamage(const std::string& path, const std::function<void()>& read);

/// Opens a bag whose records tile the file and runs `use` on it; throws likewise.
void withSoundBag(const std::string& path, const std::function<void(const rosbag::Bag&)>& use);

/// The topics of one sensor in a bag: those of one namespace, by base name.
class SensorTopics {
 public:
  using Types = std::map<std::string, std::string>;  ///< of each topic

  /// A topic that tells where a sensor is.
  struct Mark {
    std::string base, type;
  };

  /// `topics`: namespace of the sensor; empty = the only one in the bag with a topic among `marks`. Throws
  /// fsr::InputError that lists what there is.
  SensorTopics(Types types, const std::string& topics, const std::vector<Mark>& marks);
  SensorTopics(const rosbag::Bag& bag, const std::string& topics, const std::vector<Mark>& marks);

  /// The topic's name as the bag spells it, "" where it is not there.
  std::string find(const std::string& base) const;
  /// Whether the bag has a topic of this full name.
  bool has(const std::string& topic) const { return types_.count(topic) > 0; }
  /// All topics of the bag, "a, b".
  std::string list() const;
  /// Throws fsr::InputError where the topic is of another type.
  void requireType(const std::string& topic, const std::string& type) const;

 private:
  std::string findNamespace(const std::vector<Mark>& marks) const;

  Types types_;
  std::string prefix_;  // without slashes at its ends
};

}  // namespace fsr_ros
