#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "exports/message_type.h"

namespace fsr::exports {

/// What all messages of one topic have in common, so that a table can be laid out for them: looked at in a
/// first pass over the bag.
class MessageSurvey {
 public:
  explicit MessageSurvey(const MessageType& type);

  void look(std::string_view bytes);

  /// Whether columns would give every message back byte for byte. They would not where a message is none of
  /// the type, a text holds a zero byte or is longer than kLongestText, or a time is not in its usual form.
  bool plain() const { return plain_; }
  /// How long the array is in all messages; none where that differs, or where it lies in an array itself.
  std::optional<std::size_t> lengthOf(const MessageField& field) const;
  /// Of the longest text in the field [bytes].
  std::size_t longestText(const MessageField& field) const { return seen_[field.id].longest; }
  /// Value that a field of the top has in all messages; none where it differs or is no integer of 2 bytes.
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

/// Nanoseconds of a serialised time or duration, and back. `usual` is false where the nanoseconds are not 0
/// to 999999999, so that the way back would lead elsewhere.
std::int64_t nanosecondsOf(Scalar scalar, const char* bytes, bool& usual);
void timeBytes(Scalar scalar, std::int64_t nanoseconds, char* bytes);

}  // namespace fsr::exports
