#include "fsr_pressure_map/ros/bag_reader.h"

#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <filesystem>

#include "fsr_pressure_map/ros/message_events.h"
#include "fsr_pressure_map/ros/message_reader.h"
#include "fsr_pressure_map/ros/sensor_topics.h"
#include "fsr_pressure_map/settings/sha256.h"

namespace fsr_ros {

namespace {

const std::string kRaw = "raw";

// Feeds the messages of one sensor to a builder.
class Feeder {
 public:
  Feeder(const rosbag::Bag& bag, const std::string& topics, fsr::RecordingBuilder& builder)
      : bag_(bag),
        topics_(bag, topics, {{kRaw, ros::message_traits::datatype<fsr_pressure_map::MatrixFrame>()}}),
        builder_(builder) {}

  void run() {
    take<fsr_pressure_map::MatrixFrame>(kRaw);
    take<sensor_msgs::FluidPressure>("chamber_pressure");
    take<fsr_pressure_map::SurfaceCurvature>("curvature");
    take<sensor_msgs::Temperature>("temperature");
    take<fsr_pressure_map::MatrixInfo>("matrix_info");
  }

 private:
  template <typename Message>
  void take(const std::string& base) {
    const std::string topic = topics_.find(base);
    if (topic.empty()) return;
    topics_.requireType(topic, ros::message_traits::datatype<Message>());
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    for (const rosbag::MessageInstance& instance : view) {
      addEvent(reader_.read<Message>(instance), builder_);
    }
  }

  const rosbag::Bag& bag_;
  MessageReader reader_;
  SensorTopics topics_;
  fsr::RecordingBuilder& builder_;
};

}  // namespace

fsr::Recording readBag(const std::string& path, const BagReadOptions& options) {
  fsr::Recording recording;
  withSoundBag(path, [&](const rosbag::Bag& bag) {
    fsr::RecordingBuilder builder;
    Feeder(bag, options.topics, builder).run();
    fsr::RecordingOptions chosen = options.recording;
    chosen.name = std::filesystem::path(path).filename().string();
    chosen.sha256 = fsr::sha256OfFile(path);
    recording = builder.build(chosen);
  });
  return recording;
}

}  // namespace fsr_ros
