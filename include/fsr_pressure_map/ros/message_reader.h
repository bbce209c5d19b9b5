#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/message_instance.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fsr_pressure_map/exports/message_type.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

/// Reads messages out of a bag that may be damaged.
class MessageReader {
 public:
  /// As serialised; valid until the next call.
  std::string_view bytes(const rosbag::MessageInstance& instance) {
    bytes_.resize(instance.size());
    ros::serialization::OStream into(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    instance.write(into);
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
  }

  /// Throws fsr::InputError where the bag's definition of the type is another one,
  /// ros::serialization::StreamOverrunException where the message is cut short or claims more than it has:
  /// ROS would make room for as many values as a message merely claims to hold, up to 16 GB.
  template <typename Message>
  Message read(const rosbag::MessageInstance& instance) {
    const std::string type = ros::message_traits::datatype<Message>();
    if (instance.getMD5Sum() != ros::message_traits::md5sum<Message>()) {
      throw fsr::InputError(instance.getTopic() + " was recorded with another definition of " + type +
                            "; convert the bag with rosbag fix");
    }
    static const fsr::MessageType structure =
        fsr::parseMessageType(type, ros::message_traits::definition<Message>());
    if (!fsr::isMessageOf(structure, bytes(instance))) throw ros::serialization::StreamOverrunException("");
    ros::serialization::IStream from(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    Message message;
    ros::serialization::deserialize(from, message);
    return message;
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace fsr_ros
