#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/message_instance.h>
#include <std_msgs/Header.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

/// A field of a message. It has fields itself if it is a message.
struct MessageField {
  enum class Count { kOne, kFixed, kAny };

  Count count = Count::kOne;
  std::size_t fixed = 1;  ///< number of values for kFixed
  bool nested = false;    ///< whether it is a message: then `fields` is used, else `size`
  std::size_t size = 0;   ///< of one serialised value [bytes]; 0 = a text, whose length stands before it
  std::vector<MessageField> fields;
};

/// The structure of a ROS message type, from the definition in a bag.
struct MessageType {
  std::vector<MessageField> fields;
};

/// Parses a definition as in a bag's connection: the text of the message, then the texts of the types that it
/// uses, separated by a line of "=" and a line "MSG: name". Throws fsr::InputError if a type is missing or a line
/// is invalid.
MessageType parseMessageType(const std::string& name, const std::string& definition);

/// Whether the bytes are exactly one message of the type, from first to last. To be checked before memory is
/// allocated by the lengths that a message states. Reads no byte outside.
bool isMessageOf(const MessageType& type, std::string_view bytes);

/// Whether a message type of this package once had the definition of this MD5 sum, with the same fields in
/// the same order as today. ROS counts a new constant as another definition, but the recorded bytes are the
/// same, so bags with such definitions are read as they are. The rules in migration/ tell `rosbag fix` how to
/// convert them for programs that compare the sums, e.g. nodes that subscribe to what `rosbag play` plays.
bool hadDefinition(const std::string& type, const std::string& md5sum);

/// Number of texts that were added at the end of a message type since it had the definition of this MD5 sum;
/// 0 = it never had this definition, or nothing was added. Recorded bytes are read with so many empty texts
/// behind them.
std::size_t fieldsAdded(const std::string& type, const std::string& md5sum);

/// The stamp of a message [ns].
inline std::int64_t stampOf(const std_msgs::Header& header) {
  return static_cast<std::int64_t>(header.stamp.toNSec());
}

/// Whether MessageReader reads messages that were recorded with this definition as `Message`: the definition
/// is the present one, or an earlier one with the same fields or without the last ones.
template <typename Message>
bool isReadable(const std::string& md5sum) {
  return md5sum == ros::message_traits::md5sum<Message>() ||
         hadDefinition(ros::message_traits::datatype<Message>(), md5sum) ||
         fieldsAdded(ros::message_traits::datatype<Message>(), md5sum) > 0;
}

/// Throws fsr::InputError if the topic was recorded with another definition of its message type, unless it is
/// readable.
template <typename Message>
void requireDefinition(const std::string& topic, const std::string& md5sum) {
  if (isReadable<Message>(md5sum)) return;
  throw fsr::settings::InputError(topic + " was recorded with another definition of " +
                                  ros::message_traits::datatype<Message>() +
                                  "; convert the bag with rosbag fix");
}

/// Deserialises a message. Throws ros::serialization::StreamOverrunException if the message is cut short or
/// if the length of an array does not fit its bytes. Without this check ROS would allocate as much memory as
/// the length says, up to 16 GB.
template <typename Message>
void readMessage(std::uint8_t* bytes, std::size_t size, Message& message) {
  static const MessageType structure = parseMessageType(
      ros::message_traits::datatype<Message>(), ros::message_traits::definition<Message>());
  if (!isMessageOf(structure, {reinterpret_cast<const char*>(bytes), size})) {
    throw ros::serialization::StreamOverrunException("");
  }
  ros::serialization::IStream from(bytes, static_cast<std::uint32_t>(size));
  ros::serialization::deserialize(from, message);
}

/// Reads messages out of a bag that may be damaged.
class MessageReader {
 public:
  /// The serialised message; valid until the next call.
  std::string_view bytes(const rosbag::MessageInstance& instance) {
    bytes_.resize(instance.size());
    ros::serialization::OStream into(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    instance.write(into);
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
  }

  /// Throws as the two functions above.
  template <typename Message>
  Message read(const rosbag::MessageInstance& instance) {
    constexpr std::size_t kEmptyText = sizeof(std::uint32_t);  // its length, 0
    const std::string md5sum = instance.getMD5Sum();
    requireDefinition<Message>(instance.getTopic(), md5sum);
    bytes(instance);
    const std::size_t added = fieldsAdded(ros::message_traits::datatype<Message>(), md5sum);
    bytes_.resize(bytes_.size() + added * kEmptyText, 0);
    Message message;
    readMessage(bytes_.data(), bytes_.size(), message);
    return message;
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace fsr_ros
