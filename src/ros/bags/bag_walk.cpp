#include "ros/bags/bag_walk.h"

#include <rosbag/constants.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "ros/bags/bag_records.h"

namespace fsr_ros {

namespace {

using bag_records::damaged;
using bag_records::field;
using bag_records::number;
using bag_records::RecordFile;
using bag_records::takeBlock;

struct Message {
  std::uint32_t offset;  // of its record in the chunk [bytes]
  std::uint32_t connection;
  MessageBytes bytes;
  bool indexed = false;
};

bool operator<(const Message& a, const Message& b) {
  return std::tie(a.offset, a.connection) < std::tie(b.offset, b.connection);
}

// One pass over a bag: checks each record and calls `visit` for each message in the index.
class Walk {
 public:
  Walk(const std::string& path, const BagWalk::Visit& visit, const BagWalk::ReadProgress& progress)
      : file_(path), visit_(visit), progress_(progress) {}

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
        if (progress_) progress_(static_cast<double>(start) / static_cast<double>(file_.size()));
        return chunk();
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

  void chunk() {
    bag_records::unpackChunk(file_, chunk_);
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

  void index(std::string_view header, std::string_view data) {
    const auto id = field<std::uint32_t>(header, rosbag::CONNECTION_FIELD_NAME);
    const auto count = field<std::uint32_t>(header, rosbag::COUNT_FIELD_NAME);
    used_.insert(id);
    if (data.size() != std::uint64_t{count} * bag_records::kIndexEntry)
      damaged("an index has another length than it says");
    for (; !data.empty(); data.remove_prefix(bag_records::kIndexEntry)) {
      const Message wanted{number<std::uint32_t>(data.substr(8)), id, {}, false};
      const auto found = std::lower_bound(messages_.begin(), messages_.end(), wanted);
      if (found == messages_.end() || wanted < *found) damaged("an index points to no message");
      // Otherwise a small file could contain a large message any number of times.
      if (std::exchange(found->indexed, true)) damaged("an index points to a message twice");
      found->bytes.seconds = number<std::uint32_t>(data);
      found->bytes.nanoseconds = number<std::uint32_t>(data.substr(4));
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

  // Checks the data of a connection: type, definition, ...
  static void fields(std::string_view data) { field<std::string_view>(data, rosbag::TYPE_FIELD_NAME); }

  RecordFile file_;
  const BagWalk::Visit& visit_;
  const BagWalk::ReadProgress& progress_;
  std::vector<std::uint64_t> starts_, chunks_;  // positions in the file, ascending
  std::set<std::uint32_t> connections_, used_;
  std::uint64_t index_position_ = 0;
  std::uint64_t counted_chunks_ = 0;
  std::uint64_t counted_connections_ = 0;

  // The last chunk:
  std::string chunk_;
  std::vector<Message> messages_;  // ascending
};

BagConnection connectionIn(std::string_view header, std::string_view data) {
  return {std::string(field<std::string_view>(header, rosbag::TOPIC_FIELD_NAME)),
          std::string(field<std::string_view>(data, rosbag::TYPE_FIELD_NAME)),
          std::string(field<std::string_view>(data, "md5sum")),
          std::string(field<std::string_view>(data, "message_definition"))};
}

}  // namespace

BagWalk::BagWalk(const std::string& path) : path_(path) {
  RecordFile file(path);
  bytes_ = file.size();
  file.next();
  if (field<std::uint8_t>(file.header(), rosbag::OP_FIELD_NAME) != rosbag::OP_FILE_HEADER) {
    damaged("its first record is not the file's header");
  }
  const auto index_position = field<std::uint64_t>(file.header(), rosbag::INDEX_POS_FIELD_NAME);
  if (index_position == 0) throw rosbag::BagUnindexedException();
  for (file.goTo(index_position); !file.atEnd();) {
    file.next();
    const auto kind = field<std::uint8_t>(file.header(), rosbag::OP_FIELD_NAME);
    if (kind == rosbag::OP_CONNECTION)
      connections_[field<std::uint32_t>(file.header(), rosbag::CONNECTION_FIELD_NAME)] =
          connectionIn(file.header(), file.data());
    if (kind == rosbag::OP_CHUNK_INFO) addCounts(file.data());
  }
}

// Pairs of a connection and its number of messages in a chunk.
void BagWalk::addCounts(std::string_view data) {
  for (; data.size() >= 2 * sizeof(std::uint32_t); data.remove_prefix(2 * sizeof(std::uint32_t)))
    messages_[number<std::uint32_t>(data)] += number<std::uint32_t>(data.substr(sizeof(std::uint32_t)));
}

std::uint64_t BagWalk::messages(const std::string& topic) const {
  std::uint64_t sum = 0;
  for (const auto& [id, connection] : connections_) {
    const auto found = messages_.find(id);
    if (connection.topic == topic && found != messages_.end()) sum += found->second;
  }
  return sum;
}

std::string BagWalk::run(const Visit& visit, const ReadProgress& progress) const {
  return Walk(path_, visit, progress).run();
}

BagWalk::ReadProgress told(const std::string& step,
                           const std::function<void(const std::string& step, double share)>& progress) {
  if (!progress) return {};
  return [step, progress](double share) { progress(step, share); };
}

void requireSoundBag(const std::string& path, const BagWalk::ReadProgress& progress) {
  BagWalk(path).run([](std::uint32_t, MessageBytes) {}, progress);
}

}  // namespace fsr_ros
