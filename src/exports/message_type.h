#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace fsr::exports {

/// What a field of a ROS message is made of at last.
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

/// Bytes of one value as serialised; 0 for texts.
std::size_t sizeOf(Scalar scalar);

/// A field of a message, with its fields where it is a message itself.
struct MessageField {
  enum class Count { kOne, kFixed, kAny };

  std::string name;  ///< from the message's top, "header.stamp"
  std::string comment;
  Count count = Count::kOne;
  std::size_t fixed = 1;  ///< how many, for kFixed
  Scalar scalar = Scalar::kUint8;
  bool nested = false;  ///< a message: `fields` counts, `scalar` does not
  std::vector<MessageField> fields;
  bool repeated = false;  ///< lies in an array of messages
  std::size_t id = 0;     ///< number among all fields of the message
};

/// The structure of a ROS message as bags carry it along: enough to take serialised messages of any type
/// apart and to put them together again.
struct MessageType {
  std::string name;  ///< e.g. sensor_msgs/Temperature
  std::vector<MessageField> fields;
  std::size_t count = 0;  ///< of all fields, at every depth
};

/// `definition` as in a bag's connection: the message's own text, then those of the types it uses, between
/// lines of "=" and "MSG: name". Throws InputError where a type is missing or a line is none.
MessageType parseMessageType(const std::string& name, const std::string& definition);

/// Takes a serialised message apart. The visitor is told, in the order of the bytes:
///   count(field, n)          the length of an array that has one
///   values(field, bytes, n)  n values of a number, time or duration (all at once)
///   text(field, string_view)
/// False where the bytes do not have the type's structure from first to last; nothing outside is read.
template <typename Visitor>
bool visitMessage(const MessageType& type, std::string_view bytes, Visitor& visitor);

/// Whether the bytes are a whole message of the type: lengths are checked before anybody makes room for what
/// they claim.
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
    if (field.fields.empty()) continue;  // an empty message has no bytes, however often it is there
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
