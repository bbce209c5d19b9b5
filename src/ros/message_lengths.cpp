#include "fsr_pressure_map/ros/message_lengths.h"

#include <cstring>

namespace fsr_ros {

namespace {

// Bytes of one value of an array or string, 0 for a field of fixed length.
std::uint64_t valueSize(char kind) {
  switch (kind) {
    case 's':
    case 'b':
      return 1;
    case 'h':
      return 2;
    case 'f':
      return 4;
    default:
      return 0;
  }
}

}  // namespace

bool lengthsFit(const std::vector<std::uint8_t>& bytes, const char* format) {
  std::uint64_t at = 0;
  for (; *format != '\0'; ++format) {
    const std::uint64_t value = valueSize(*format);
    if (value == 0) {
      at += static_cast<std::uint64_t>(*format - '0');
      continue;
    }
    std::uint32_t count = 0;
    if (at + sizeof(count) > bytes.size()) return false;
    std::memcpy(&count, bytes.data() + at, sizeof(count));
    at += sizeof(count) + value * count;
    if (at > bytes.size()) return false;
  }
  return at == bytes.size();
}

}  // namespace fsr_ros
