#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fsr::exports {

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
/// uses, separated by a line of "=" and a line "MSG: name". Throws InputError if a type is missing or a line
/// is invalid.
MessageType parseMessageType(const std::string& name, const std::string& definition);

/// Whether the bytes are exactly one message of the type, from first to last. To be checked before memory is
/// allocated by the lengths that a message states. Reads no byte outside.
bool isMessageOf(const MessageType& type, std::string_view bytes);

}  // namespace fsr::exports
