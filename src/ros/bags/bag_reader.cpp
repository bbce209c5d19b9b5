#include "fsr_pressure_map/ros/bag_reader.h"

#include <ros/message_traits.h>

#include <filesystem>
#include <functional>
#include <map>

#include "dataset/recording_builder.h"
#include "ros/bags/bag_walk.h"
#include "ros/bags/message_events.h"
#include "ros/bags/sensor_topics.h"
#include "ros/messages/message_reader.h"

namespace fsr_ros {

namespace {

const std::string kRaw = "raw";

// Feeds the messages of one sensor to a builder.
class Feeder {
 public:
  Feeder(const BagWalk& bag, const std::string& topics, fsr::dataset::RecordingBuilder& builder)
      : bag_(bag),
        topics_(typesOf(bag), topics,
                {{kRaw, ros::message_traits::datatype<fsr_pressure_map::MatrixFrame>()}}),
        builder_(builder) {}

  // Returns the SHA-256 of the bag.
  std::string run(const BagWalk::ReadProgress& progress) {
    take<fsr_pressure_map::MatrixFrame>(kRaw);
    // The bag may say anything, and it may be packed: no more memory than twice the file at first.
    builder_.expectScans(bag_.messages(topics_.find(kRaw)), 2 * bag_.bytes());
    take<sensor_msgs::FluidPressure>("chamber_pressure");
    take<fsr_pressure_map::SurfaceCurvature>("curvature");
    take<sensor_msgs::Temperature>("temperature");
    take<fsr_pressure_map::MatrixInfo>("matrix_info");
    take<fsr_pressure_map::Event>("events");
    return bag_.run(
        [&](std::uint32_t connection, MessageBytes bytes) {
          const auto found = readers_.find(connection);
          if (found != readers_.end()) found->second(bytes);
        },
        progress);
  }

 private:
  template <typename Message>
  void take(const std::string& base) {
    const std::string topic = topics_.find(base);
    if (topic.empty()) return;
    topics_.requireType(topic, ros::message_traits::datatype<Message>());
    for (const auto& [id, connection] : bag_.connections()) {
      if (connection.topic != topic) continue;
      requireDefinition<Message>(topic, connection.md5sum);
      readers_[id] = [this, message = Message()](MessageBytes bytes) mutable {
        readMessage(bytes.data, bytes.size, message);
        addEvent(message, builder_);
      };
    }
  }

  const BagWalk& bag_;
  SensorTopics topics_;
  fsr::dataset::RecordingBuilder& builder_;
  std::map<std::uint32_t, std::function<void(MessageBytes)>> readers_;  // by connection number
};

}  // namespace

fsr::dataset::Recording readBag(const std::string& path, const BagReadOptions& options) {
  fsr::dataset::Recording recording;
  tellingOfDamage(path, [&] {
    fsr::dataset::RecordingBuilder builder(options.counts_in_memory);
    const BagWalk bag(path);
    fsr::dataset::RecordingOptions chosen;
    chosen.ambient_pressure = options.ambient_pressure;
    chosen.change_margin = options.change_margin;
    chosen.name = std::filesystem::path(path).filename().string();
    chosen.sha256 = Feeder(bag, options.topics, builder).run(options.progress);
    recording = builder.take(chosen);
  });
  return recording;
}

}  // namespace fsr_ros
