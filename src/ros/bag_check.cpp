#include "fsr_pressure_map/ros/bag_check.h"

#include <rosbag/constants.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
constexpr std::size_t kIndexEntry = 12;  // time, offset into the chunk [bytes]

[[noreturn]] void damaged(const std::string& what) {
  throw fsr::InputError("is no whole bag (" + what + ")");
}

// Little endian, as the machines that ROS runs on.
template <typename T>
T number(std::string_view bytes) {
  T value{};
  if (bytes.size() < sizeof(T)) damaged("a number is cut short");
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

// Takes a length and as many bytes off the front.
std::string_view takeBlock(std::string_view& rest) {
  const auto size = number<std::uint32_t>(rest);
  rest.remove_prefix(sizeof(size));
  if (size > rest.size()) damaged("a length points behind its end");
  const std::string_view block = rest.substr(0, size);
  rest.remove_prefix(size);
  return block;
}

// The value of a field of a record's header: "length name=value" one after the other.
template <typename T>
T field(std::string_view header, const std::string& name) {
  while (!header.empty()) {
    const std::string_view entry = takeBlock(header);
    const std::size_t equals = entry.find('=');
    if (equals == std::string_view::npos) damaged("a header field has no value");
    if (entry.substr(0, equals) != name) continue;
    if constexpr (std::is_same_v<T, std::string_view>) {
      return entry.substr(equals + 1);
    } else {
      return number<T>(entry.substr(equals + 1));
    }
  }
  damaged("a record has no field " + name);
}

struct Message {
  std::uint32_t offset;  // of its record in the chunk [bytes]
  std::uint32_t connection;
  bool operator<(const Message& other) const {
    return std::tie(offset, connection) < std::tie(other.offset, other.connection);
  }
};

class BagWalk {
 public:
  explicit BagWalk(const std::string& path)
      : file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {}

  void run() {
    if (take(sizeof(kMagic) - 1) != kMagic) damaged("it does not begin with #ROSBAG V2.0");
    while (position_ < size_) record();
    if (index_position_ == 0) throw rosbag::BagUnindexedException();
    if (starts_.count(index_position_) == 0) damaged("its index is not where the header says");
    if (counted_chunks_ != chunks_.size() || counted_connections_ != connections_.size()) {
      damaged("it does not hold as many chunks and connections as the header says");
    }
    for (const std::uint32_t id : used_) {
      if (connections_.count(id) == 0) damaged("a message belongs to no connection");
    }
  }

 private:
  const std::string& take(std::uint64_t size) {
    if (size > size_ - position_) damaged("a record ends behind the file's end");
    bytes_.resize(size);
    if (!file_.read(bytes_.data(), static_cast<std::streamsize>(size)))
      damaged("it cannot be read to its end");
    position_ += size;
    return bytes_;
  }

  std::string block() {
    const auto size = number<std::uint32_t>(take(sizeof(std::uint32_t)));
    return take(size);
  }

  void record() {
    const std::uint64_t start = position_;
    starts_.insert(start);
    const std::string header = block();
    const std::string data = block();
    switch (field<std::uint8_t>(header, rosbag::OP_FIELD_NAME)) {
      case rosbag::OP_FILE_HEADER:
        return fileHeader(header);
      case rosbag::OP_CHUNK:
        chunks_.insert(start);
        return chunk(header, data);
      case rosbag::OP_INDEX_DATA:
        return index(header, data);
      case rosbag::OP_CONNECTION:
        return connection(header, data);
      case rosbag::OP_CHUNK_INFO:
        return chunkInfo(header, data);
      default:
        damaged("a record of unknown kind");
    }
  }

  void fileHeader(std::string_view header) {
    index_position_ = field<std::uint64_t>(header, rosbag::INDEX_POS_FIELD_NAME);
    counted_connections_ = field<std::uint32_t>(header, rosbag::CONNECTION_COUNT_FIELD_NAME);
    counted_chunks_ = field<std::uint32_t>(header, rosbag::CHUNK_COUNT_FIELD_NAME);
  }

  void chunk(std::string_view header, std::string_view data) {
    chunk_size_ = field<std::uint32_t>(header, rosbag::SIZE_FIELD_NAME);
    messages_.clear();
    looked_inside_ =
        field<std::string_view>(header, rosbag::COMPRESSION_FIELD_NAME) == rosbag::COMPRESSION_NONE;
    if (!looked_inside_) return;
    if (chunk_size_ != data.size()) damaged("a chunk has another size than it says");
    const char* const begin = data.data();
    while (!data.empty()) {
      const auto offset = static_cast<std::uint32_t>(data.data() - begin);
      const std::string_view inner = takeBlock(data);
      const std::string_view content = takeBlock(data);
      const auto kind = field<std::uint8_t>(inner, rosbag::OP_FIELD_NAME);
      if (kind == rosbag::OP_CONNECTION) fields(content);
      if (kind != rosbag::OP_MSG_DATA) continue;
      messages_.push_back({offset, field<std::uint32_t>(inner, rosbag::CONNECTION_FIELD_NAME)});
    }
  }

  void index(std::string_view header, std::string_view data) {
    const auto id = field<std::uint32_t>(header, rosbag::CONNECTION_FIELD_NAME);
    const auto count = field<std::uint32_t>(header, rosbag::COUNT_FIELD_NAME);
    used_.insert(id);
    if (data.size() != std::uint64_t{count} * kIndexEntry)
      damaged("an index has another length than it says");
    for (; !data.empty(); data.remove_prefix(kIndexEntry)) {
      const auto offset = number<std::uint32_t>(data.substr(8));
      const bool found = looked_inside_
                             ? std::binary_search(messages_.begin(), messages_.end(), Message{offset, id})
                             : offset < chunk_size_;
      if (!found) damaged("an index points to no message");
    }
  }

  void connection(std::string_view header, std::string_view data) {
    fields(data);
    field<std::string_view>(header, rosbag::TOPIC_FIELD_NAME);
    connections_.insert(field<std::uint32_t>(header, rosbag::CONNECTION_FIELD_NAME));
  }

  void chunkInfo(std::string_view header, std::string_view data) {
    const auto count = field<std::uint32_t>(header, rosbag::COUNT_FIELD_NAME);
    if (data.size() != std::uint64_t{count} * 8)
      damaged("a chunk's description has another length than it says");
    if (chunks_.count(field<std::uint64_t>(header, rosbag::CHUNK_POS_FIELD_NAME)) == 0) {
      damaged("a chunk is not where its description says");
    }
  }

  // A connection's own header: type, definition, ...
  static void fields(std::string_view data) { field<std::string_view>(data, "type"); }

  std::ifstream file_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
  std::string bytes_;

  std::set<std::uint64_t> starts_;  // of the records of the file
  std::set<std::uint64_t> chunks_;
  std::set<std::uint32_t> connections_;
  std::set<std::uint32_t> used_;
  std::uint64_t index_position_ = 0;
  std::uint64_t counted_chunks_ = 0;
  std::uint64_t counted_connections_ = 0;

  // Of the chunk that was met last:
  std::uint32_t chunk_size_ = 0;
  bool looked_inside_ = false;
  std::vector<Message> messages_;  // ascending
};

}  // namespace

void requireSoundBag(const std::string& path) {
  BagWalk(path).run();
}

}  // namespace fsr_ros
