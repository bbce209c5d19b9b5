#include "ros/bags/bag_walk.h"

#include <rosbag/chunked_file.h>
#include <rosbag/constants.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "settings/sha256.h"

namespace fsr_ros {

namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
constexpr std::size_t kIndexEntry = 12;            // time, offset into the chunk [bytes]
constexpr std::uint32_t kLargestChunk = 1u << 27;  // unpacked [bytes]; rosbag record makes them of 768 KB

[[noreturn]] void damaged(const std::string& what) {
  throw rosbag::BagFormatException(what);
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
T field(std::string_view header, std::string_view name) {
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
  damaged("a record has no field " + std::string(name));
}

// The records of the file, one after the other.
class RecordFile {
 public:
  explicit RecordFile(const std::string& path)
      : file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {
    take(sizeof(kMagic) - 1, header_);
    if (header_ != kMagic) damaged("it does not begin with #ROSBAG V2.0");
  }

  std::uint64_t position() const { return position_; }
  bool atEnd() const { return position_ >= size_; }
  void goTo(std::uint64_t position) {
    if (position > size_) damaged("its index begins behind the file's end");
    position_ = position;
    file_.seekg(static_cast<std::streamoff>(position));
  }
  // Makes header() and data() those of the next record.
  void next() {
    takeBlock(header_);
    takeBlock(data_);
  }

  const std::string& header() const { return header_; }
  std::string& data() { return data_; }
  // Of all bytes that were read.
  std::string sha256() { return hash_.hexadecimal(); }

 private:
  void take(std::uint64_t size, std::string& into) {
    if (size > size_ - position_) damaged("a record ends behind the file's end");
    into.resize(size);
    if (!file_.read(into.data(), static_cast<std::streamsize>(size))) damaged("it cannot be read to its end");
    position_ += size;
    hash_.add(into.data(), size);
  }

  void takeBlock(std::string& into) {
    take(sizeof(std::uint32_t), into);
    take(number<std::uint32_t>(into), into);
  }

  std::ifstream file_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
  std::string header_, data_;
  fsr::settings::Sha256 hash_;
};

std::map<std::uint32_t, BagConnection> indexedConnections(const std::string& path) {
  RecordFile file(path);
  file.next();
  if (field<std::uint8_t>(file.header(), rosbag::OP_FIELD_NAME) != rosbag::OP_FILE_HEADER) {
    damaged("its first record is not the file's header");
  }
  const auto index_position = field<std::uint64_t>(file.header(), rosbag::INDEX_POS_FIELD_NAME);
  if (index_position == 0) throw rosbag::BagUnindexedException();
  std::map<std::uint32_t, BagConnection> connections;
  for (file.goTo(index_position); !file.atEnd();) {
    file.next();
    const std::string& header = file.header();
    if (field<std::uint8_t>(header, rosbag::OP_FIELD_NAME) != rosbag::OP_CONNECTION) continue;
    connections[field<std::uint32_t>(header, rosbag::CONNECTION_FIELD_NAME)] = {
        std::string(field<std::string_view>(header, rosbag::TOPIC_FIELD_NAME)),
        std::string(field<std::string_view>(file.data(), rosbag::TYPE_FIELD_NAME)),
        std::string(field<std::string_view>(file.data(), "md5sum"))};
  }
  return connections;
}

struct Message {
  std::uint32_t offset;  // of its record in the chunk [bytes]
  std::uint32_t connection;
  MessageBytes bytes;
  bool indexed = false;
};

bool operator<(const Message& a, const Message& b) {
  return std::tie(a.offset, a.connection) < std::tie(b.offset, b.connection);
}

class Walk {
 public:
  Walk(const std::string& path, const BagWalk::Visit& visit) : file_(path), visit_(visit) {}

  std::string run() {
    while (!file_.atEnd()) record();
    if (index_position_ == 0) throw rosbag::BagUnindexedException();
    if (!std::binary_search(starts_.begin(), starts_.end(), index_position_)) {
      damaged("its index is not where the header says");
    }
    if (counted_chunks_ != chunks_.size() || counted_connections_ != connections_.size()) {
      damaged("it does not hold as many chunks and connections as the header says");
    }
    for (const std::uint32_t id : used_) {
      if (connections_.count(id) == 0) damaged("a message belongs to no connection");
    }
    return file_.sha256();
  }

 private:
  void record() {
    const std::uint64_t start = file_.position();
    starts_.push_back(start);
    file_.next();
    const std::string& header = file_.header();
    switch (field<std::uint8_t>(header, rosbag::OP_FIELD_NAME)) {
      case rosbag::OP_FILE_HEADER:
        return fileHeader(header);
      case rosbag::OP_CHUNK:
        chunks_.push_back(start);
        return chunk(header);
      case rosbag::OP_INDEX_DATA:
        return index(header, file_.data());
      case rosbag::OP_CONNECTION:
        return connection(header, file_.data());
      case rosbag::OP_CHUNK_INFO:
        return chunkInfo(header, file_.data());
      default:
        damaged("a record of unknown kind");
    }
  }

  void fileHeader(std::string_view header) {
    index_position_ = field<std::uint64_t>(header, rosbag::INDEX_POS_FIELD_NAME);
    counted_connections_ = field<std::uint32_t>(header, rosbag::CONNECTION_COUNT_FIELD_NAME);
    counted_chunks_ = field<std::uint32_t>(header, rosbag::CHUNK_COUNT_FIELD_NAME);
  }

  void chunk(std::string_view header) {
    unpack(field<std::string_view>(header, rosbag::COMPRESSION_FIELD_NAME),
           field<std::uint32_t>(header, rosbag::SIZE_FIELD_NAME));
    messages_.clear();
    std::string_view rest = chunk_;
    while (!rest.empty()) {
      const auto offset = static_cast<std::uint32_t>(rest.data() - chunk_.data());
      const std::string_view inner = takeBlock(rest);
      const std::string_view content = takeBlock(rest);
      const auto kind = field<std::uint8_t>(inner, rosbag::OP_FIELD_NAME);
      if (kind == rosbag::OP_CONNECTION) fields(content);
      if (kind != rosbag::OP_MSG_DATA) continue;
      auto* const data = reinterpret_cast<std::uint8_t*>(chunk_.data() + (content.data() - chunk_.data()));
      messages_.push_back({offset,
                           field<std::uint32_t>(inner, rosbag::CONNECTION_FIELD_NAME),
                           {data, static_cast<std::uint32_t>(content.size())},
                           false});
    }
  }

  // The record's data, which rosbag has packed as `compression` says, to `chunk_`.
  void unpack(std::string_view compression, std::uint32_t size) {
    std::string& packed = file_.data();
    if (compression == rosbag::COMPRESSION_NONE) {
      if (size != packed.size()) damaged("a chunk has another size than it says");
      chunk_.swap(packed);
      return;
    }
    const bool lz4 = compression == rosbag::COMPRESSION_LZ4;
    if (!lz4 && compression != rosbag::COMPRESSION_BZ2) damaged("a chunk is packed in an unknown way");
    if (size > kLargestChunk) damaged("a chunk says that it is larger than 128 MiB");
    chunk_.resize(size);
    rosbag::ChunkedFile().decompress(lz4 ? rosbag::compression::LZ4 : rosbag::compression::BZ2,
                                     reinterpret_cast<std::uint8_t*>(chunk_.data()), size,
                                     reinterpret_cast<std::uint8_t*>(packed.data()),
                                     static_cast<unsigned int>(packed.size()));
  }

  void index(std::string_view header, std::string_view data) {
    const auto id = field<std::uint32_t>(header, rosbag::CONNECTION_FIELD_NAME);
    const auto count = field<std::uint32_t>(header, rosbag::COUNT_FIELD_NAME);
    used_.insert(id);
    if (data.size() != std::uint64_t{count} * kIndexEntry)
      damaged("an index has another length than it says");
    for (; !data.empty(); data.remove_prefix(kIndexEntry)) {
      const Message wanted{number<std::uint32_t>(data.substr(8)), id, {}, false};
      const auto found = std::lower_bound(messages_.begin(), messages_.end(), wanted);
      if (found == messages_.end() || wanted < *found) damaged("an index points to no message");
      // Else a small file could hold a large message any number of times.
      if (std::exchange(found->indexed, true)) damaged("an index points to a message twice");
      visit_(id, found->bytes);
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
    const auto position = field<std::uint64_t>(header, rosbag::CHUNK_POS_FIELD_NAME);
    if (!std::binary_search(chunks_.begin(), chunks_.end(), position)) {
      damaged("a chunk is not where its description says");
    }
  }

  // A connection's own header: type, definition, ...
  static void fields(std::string_view data) { field<std::string_view>(data, rosbag::TYPE_FIELD_NAME); }

  RecordFile file_;
  const BagWalk::Visit& visit_;
  std::vector<std::uint64_t> starts_, chunks_;  // of the records of the file, ascending
  std::set<std::uint32_t> connections_, used_;
  std::uint64_t index_position_ = 0;
  std::uint64_t counted_chunks_ = 0;
  std::uint64_t counted_connections_ = 0;

  // Of the chunk that was met last:
  std::string chunk_;
  std::vector<Message> messages_;  // ascending
};

}  // namespace

BagWalk::BagWalk(const std::string& path) : path_(path), connections_(indexedConnections(path)) {}

std::string BagWalk::run(const Visit& visit) const {
  return Walk(path_, visit).run();
}

void requireSoundBag(const std::string& path) {
  BagWalk(path).run([](std::uint32_t, MessageBytes) {});
}

}  // namespace fsr_ros
