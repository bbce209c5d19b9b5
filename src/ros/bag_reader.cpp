#include "fsr_pressure_map/ros/bag_reader.h"

#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "fsr_pressure_map/ros/bag_check.h"
#include "fsr_pressure_map/ros/message_events.h"
#include "fsr_pressure_map/ros/message_lengths.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/sha256.h"

namespace fsr_ros {

namespace {

const std::string kRaw = "raw";

std::string withoutSlashes(const std::string& name) {
  const std::size_t first = name.find_first_not_of('/');
  return first == std::string::npos ? "" : name.substr(first, name.find_last_not_of('/') - first + 1);
}

template <typename Names>
std::string listOf(const Names& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none" : list;
}

// Type of each topic.
std::map<std::string, std::string> topicsOf(const rosbag::Bag& bag) {
  std::map<std::string, std::string> topics;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    topics[connection->topic] = connection->datatype;
  }
  return topics;
}

std::vector<std::string> namesOf(const std::map<std::string, std::string>& topics) {
  std::vector<std::string> names;
  for (const auto& entry : topics) names.push_back(entry.first);
  return names;
}

// The namespace, without slashes at its ends, of the one sensor in the bag.
std::string findNamespace(const std::map<std::string, std::string>& topics) {
  std::set<std::string> found;
  for (const auto& [topic, type] : topics) {
    const std::string name = "/" + withoutSlashes(topic);
    const std::size_t base = name.rfind('/') + 1;
    if (name.substr(base) == kRaw && type == ros::message_traits::datatype<fsr_pressure_map::MatrixFrame>()) {
      found.insert(withoutSlashes(name.substr(0, base)));
    }
  }
  if (found.empty()) {
    throw fsr::InputError("holds no topic raw of type fsr_pressure_map/MatrixFrame, but " +
                          listOf(namesOf(topics)) + "; record with record.launch");
  }
  if (found.size() > 1) {
    throw fsr::InputError("holds several sensors: " + listOf(found) + "; choose one with --namespace");
  }
  return *found.begin();
}

// Feeds the messages of one sensor to a builder.
class Feeder {
 public:
  Feeder(const rosbag::Bag& bag, const std::string& topics, fsr::RecordingBuilder& builder)
      : bag_(bag), types_(topicsOf(bag)), builder_(builder) {
    const std::string name = withoutSlashes(topics);
    prefix_ = name.empty() ? findNamespace(types_) : name;
  }

  void run() {
    take<fsr_pressure_map::MatrixFrame>(kRaw);
    take<sensor_msgs::FluidPressure>("chamber_pressure");
    take<fsr_pressure_map::SurfaceCurvature>("curvature");
    take<sensor_msgs::Temperature>("temperature");
    take<fsr_pressure_map::MatrixInfo>("matrix_info");
  }

 private:
  // The topic's name as the bag spells it, "" where it is not there.
  std::string find(const std::string& base) const {
    const std::string wanted = prefix_.empty() ? base : prefix_ + "/" + base;
    for (const auto& entry : types_) {
      if (withoutSlashes(entry.first) == wanted) return entry.first;
    }
    if (base == kRaw) {
      throw fsr::InputError("holds no topic /" + wanted + ", but " + listOf(namesOf(types_)) +
                            "; choose the sensor with --namespace");
    }
    return "";
  }

  template <typename Message>
  void take(const std::string& base) {
    const std::string topic = find(base);
    if (topic.empty()) return;
    const std::string type = ros::message_traits::datatype<Message>();
    if (types_.at(topic) != type) {
      throw fsr::InputError(topic + " is of type " + types_.at(topic) + ", but must be " + type);
    }
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    for (const rosbag::MessageInstance& instance : view) {
      if (instance.getMD5Sum() != ros::message_traits::md5sum<Message>()) {
        throw fsr::InputError(topic + " was recorded with another definition of " + type +
                              "; convert the bag with rosbag fix");
      }
      addEvent(read<Message>(instance), builder_);
    }
  }

  // ROS makes room for as many values as a message merely claims to hold, up to 16 GB: looked at before.
  template <typename Message>
  Message read(const rosbag::MessageInstance& instance) {
    bytes_.resize(instance.size());
    ros::serialization::OStream into(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    instance.write(into);
    if (!lengthsAreHonest<Message>(bytes_)) throw ros::serialization::StreamOverrunException("");
    ros::serialization::IStream from(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    Message message;
    ros::serialization::deserialize(from, message);
    return message;
  }

  const rosbag::Bag& bag_;
  std::vector<std::uint8_t> bytes_;
  std::map<std::string, std::string> types_;
  fsr::RecordingBuilder& builder_;
  std::string prefix_;
};

void feed(const std::string& path, const std::string& topics, fsr::RecordingBuilder& builder) {
  const std::string way_out = "; copy it again, or save what is left with: rosbag reindex " + path;
  try {
    requireSoundBag(path);
  } catch (const rosbag::BagUnindexedException&) {
    throw fsr::InputError("the bag was not closed and has no index; run: rosbag reindex " + path);
  } catch (const fsr::InputError& complaint) {
    throw fsr::InputError(complaint.what() + way_out);
  }
  try {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    Feeder(bag, topics, builder).run();
  } catch (const rosbag::BagException& error) {
    throw fsr::InputError(std::string("is no whole bag (") + error.what() + ")" + way_out);
  } catch (const ros::serialization::StreamOverrunException&) {
    throw fsr::InputError("a message in it is cut short" + way_out);
  }
}

}  // namespace

fsr::Recording readBag(const std::string& path, const BagReadOptions& options) {
  try {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw fsr::InputError("there is no such file");
    if (std::filesystem::file_size(path, error) == 0) {
      throw fsr::InputError("is empty; give a bag that record.launch has written");
    }
    fsr::RecordingBuilder builder;
    feed(path, options.topics, builder);
    fsr::RecordingOptions recording = options.recording;
    recording.name = std::filesystem::path(path).filename().string();
    recording.sha256 = fsr::sha256OfFile(path);
    return builder.build(recording);
  } catch (const fsr::InputError& complaint) {
    throw fsr::InputError(path + ": " + complaint.what());
  }
}

}  // namespace fsr_ros
