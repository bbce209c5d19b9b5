#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <type_traits>

#include "settings/sha256.h"

/// The records of a bag file, see http://wiki.ros.org/Bags/Format/2.0. Every function throws
/// rosbag::BagFormatException if a length points behind the end of its data.
namespace fsr_ros::bag_records {

constexpr std::size_t kIndexEntry = 12;  ///< size of an index entry: time and offset into the chunk [bytes]

[[noreturn]] void damaged(const std::string& what);

/// Reads a number, little endian, as on the computers that ROS runs on.
template <typename T>
T number(std::string_view bytes) {
  T value{};
  if (bytes.size() < sizeof(T)) damaged("a number is cut short");
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

/// Takes a length and as many bytes off the front of `rest`.
std::string_view takeBlock(std::string_view& rest);

/// The bytes of a field in the header of a record, which is a sequence of "length name=value".
std::string_view fieldBytes(std::string_view header, std::string_view name);

/// The value of a field: a number, or its bytes.
template <typename T>
T field(std::string_view header, std::string_view name) {
  if constexpr (std::is_same_v<T, std::string_view>) {
    return fieldBytes(header, name);
  } else {
    return number<T>(fieldBytes(header, name));
  }
}

/// Reads the records of a file one after the other.
class RecordFile {
 public:
  /// Whether the SHA-256 of what is read is computed, which takes most of the time of reading.
  enum class Hash { kNone, kSha256 };

  explicit RecordFile(const std::string& path, Hash hash = Hash::kSha256);

  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }
  bool atEnd() const { return position_ >= size_; }
  void goTo(std::uint64_t position);
  /// Reads the next record into header() and data().
  void next();
  /// Reads the header of the next record and returns the size of its data, which are read next.
  std::uint32_t nextHeader();
  /// Reads `size` bytes.
  void take(std::uint64_t size, std::string& into);

  const std::string& header() const { return header_; }
  std::string& data() { return data_; }
  /// SHA-256 of all bytes that were read.
  std::string sha256() { return hash_.hexadecimal(); }

 private:
  std::ifstream file_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
  std::string header_, data_;
  const bool hashes_;
  fsr::settings::Sha256 hash_;
};

/// Unpacks the chunk that was read last from `file`, whose data may be gone afterwards.
void unpackChunk(RecordFile& file, std::string& chunk);

}  // namespace fsr_ros::bag_records
