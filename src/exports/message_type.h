#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace fsr::exports {

/// Type of a field of a ROS message that is not itself a message.
enum class Scalar {
  kBool,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
  kString,
  kTime,      ///< uint32 seconds, uint32 nanoseconds
  kDuration,  ///< int32 seconds, int32 nanoseconds
};

/// Size of one serialised value [bytes]; 0 for texts.
std::size_t sizeOf(Scalar scalar);

/// A field of a message. It has fields itself if it is a message.
struct MessageField {
  enum class Count { kOne, kFixed, kAny };

  std::string name;  ///< path from the top of the message, e.g. "header.stamp"
  std::string comment;
  Count count = Count::kOne;
  std::size_t fixed = 1;  ///< number of values for kFixed
  Scalar scalar = Scalar::kUint8;
  bool nested = false;  ///< whether it is a message: then `fields` is used, else `scalar`
  std::vector<MessageField> fields;
  bool repeated = false;  ///< whether it is inside an array of messages
  std::size_t id = 0;     ///< number among all fields of the message
};

/// The structure of a ROS message type, from the definition in a bag. It is enough to read and write
/// serialised messages of any type.
struct MessageType {
  std::string name;  ///< e.g. sensor_msgs/Temperature
  std::vector<MessageField> fields;
  std::size_t count = 0;  ///< number of all fields, at every depth
};

/// Parses a definition as in a bag's connection: the text of the message, then the texts of the types that it
/// uses, separated by a line of "=" and a line "MSG: name". Throws InputError if a type is missing or a line
/// is invalid.
MessageType parseMessageType(const std::string& name, const std::string& definition);

/// Reads a serialised message. Calls the visitor in the order of the bytes:
///   count(field, n)          the length of an array of variable length
///   values(field, bytes, n)  n values of a number, time or duration
///   text(field, string_view)
/// Returns false if the bytes do not have the structure of the type from first to last. Reads no byte
/// outside.
template <typename Visitor>
bool visitMessage(const MessageType& type, std::string_view bytes, Visitor& visitor);

/// Whether the bytes are exactly one message of the type. To be checked before memory is allocated by the
/// lengths that a message states.
bool isMessageOf(const MessageType& type, std::string_view bytes);

namespace message_detail {

inline bool takeLength(std::string_view& bytes, std::uint32_t& length) {
  if (bytes.size() < sizeof(length)) return false;
  std::memcpy(&length, bytes.data(), sizeof(length));
  bytes.remove_prefix(sizeof(length));
  return true;
}

template <typename Visitor>
bool visitScalars(const MessageField& field, std::size_t count, std::string_view& bytes, Visitor& visitor) {
  if (field.scalar == Scalar::kString) {
    for (; count > 0; --count) {
      std::uint32_t length = 0;
      if (!takeLength(bytes, length) || length > bytes.size()) return false;
      visitor.text(field, bytes.substr(0, length));
      bytes.remove_prefix(length);
    }
    return true;
  }
  const std::size_t size = sizeOf(field.scalar);
  if (count > bytes.size() / size) return false;
  visitor.values(field, bytes.data(), count);
  bytes.remove_prefix(count * size);
  return true;
}

template <typename Visitor>
bool visitFields(const std::vector<MessageField>& fields, std::string_view& bytes, Visitor& visitor) {
  for (const MessageField& field : fields) {
    std::size_t count = field.fixed;
    if (field.count == MessageField::Count::kAny) {
      std::uint32_t length = 0;
      if (!takeLength(bytes, length)) return false;
      visitor.count(field, length);
      count = length;
    }
    if (!field.nested) {
      if (!visitScalars(field, count, bytes, visitor)) return false;
      continue;
    }
    if (field.fields.empty()) continue;  // an empty message has no bytes
    for (; count > 0; --count) {
      if (!visitFields(field.fields, bytes, visitor)) return false;
    }
  }
  return true;
}

}  // namespace message_detail

template <typename Visitor>
bool visitMessage(const MessageType& type, std::string_view bytes, Visitor& visitor) {
  return message_detail::visitFields(type.fields, bytes, visitor) && bytes.empty();
}

}  // namespace fsr::exports
