#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "exports/message_type.h"

namespace fsr::exports {

/// Properties of all messages of one topic, found in a first pass over the bag. They determine the layout of
/// the topic's datasets.
class MessageSurvey {
 public:
  explicit MessageSurvey(const MessageType& type);

  void look(std::string_view bytes);

  /// Whether every message can be restored from columns byte for byte. This is not the case if a message is
  /// not of the type, if a text contains a zero byte or is longer than kLongestText, or if a time is not in
  /// its usual form.
  bool plain() const { return plain_; }
  /// Length of the array in all messages; none if it differs, or if the array is in an array itself.
  std::optional<std::size_t> lengthOf(const MessageField& field) const;
  /// Length of the longest text in the field [bytes].
  std::size_t longestText(const MessageField& field) const { return seen_[field.id].longest; }
  /// Value of a uint16 field of the top level that is the same in all messages; else none.
  std::optional<std::size_t> constant(const std::string& field) const;

  static constexpr std::size_t kLongestText = 4096;  // [bytes]

 private:
  struct Seen {
    bool any = false;
    std::uint32_t least = 0, most = 0;  // length of the array, or value of a uint16
    std::size_t longest = 0;            // text [bytes]
  };
  struct Look;

  const MessageType& type_;
  std::vector<Seen> seen_;  // by MessageField::id
  bool plain_ = true;
};

/// Converts a serialised time or duration to nanoseconds, and back. `usual` is false if its nanoseconds are
/// not 0 to 999999999: then the conversion back gives other bytes.
std::int64_t nanosecondsOf(Scalar scalar, const char* bytes, bool& usual);
void timeBytes(Scalar scalar, std::int64_t nanoseconds, char* bytes);

}  // namespace fsr::exports
