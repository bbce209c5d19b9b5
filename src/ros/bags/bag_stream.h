#pragma once

#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ros/bags/bag_records.h"
#include "ros/bags/bag_walk.h"
#include "ros/messages/message_reader.h"

namespace fsr_ros {

/// A connection of a bag with its messages.
struct StreamedConnection {
  BagConnection about;
  std::map<std::string, std::string> header;  ///< fields that the publisher sent
  std::uint32_t id = 0;                       ///< number in the bag

  /// Name of the node that published; empty = not recorded.
  std::string publisher() const {
    const auto found = header.find("callerid");
    return found == header.end() ? "" : found->second;
  }
};

/// A message, in memory that belongs to the stream.
struct StreamedMessage {
  std::size_t connection;  ///< index into BagStream::connections()
  const BagConnection& about;
  ros::Time received;
  std::uint8_t* data;
  std::uint32_t size;
};

/// Deserialises a message. Throws as MessageReader.
template <typename Message>
Message readStreamed(const StreamedMessage& message) {
  return MessageReader::read<Message>(message.about.topic, message.about.md5sum, message.data, message.size);
}

/// Which messages are read.
struct StreamQuery {
  std::vector<std::string> topics = {};             ///< full names; empty = all
  std::function<void(double share)> progress = {};  ///< called now and then with the share that is done
};

/// Reads the messages of a bag in the order of their reception, in exactly the order of rosbag::View. rosbag
/// keeps an index of every message in memory, 64 bytes each: a sixth of a bag of scans. This class reads the
/// index chunk by chunk and keeps some bytes for each chunk, which is a ten-thousandth of the bag.
///
/// The bag must be sound (requireSoundBag). Throws rosbag::BagException.
class BagStream {
 public:
  explicit BagStream(const std::string& path);

  /// Connections that have a message, by ascending number.
  const std::vector<StreamedConnection>& connections() const { return connections_; }
  /// Message type of each topic.
  std::map<std::string, std::string> types() const;
  /// Time of the first message; TIME_MAX where there is none.
  ros::Time begin() const;

  /// Calls take(message) until it returns false. Returns the number of messages taken.
  using Take = std::function<bool(const StreamedMessage& message)>;
  std::uint64_t forEach(const StreamQuery& query, const Take& take) const;

 private:
  // Index entries of one connection in one chunk.
  struct Run {
    std::uint64_t chunk = 0;  // position in the file
    std::uint64_t index = 0;  // likewise, of the record
    std::uint32_t order = 0;  // in the file
    ros::Time first;          // earliest time of reception
  };
  class Cursor;
  class Chunks;

  void readConnections(bag_records::RecordFile& file);
  void readRuns(bag_records::RecordFile& file, std::uint64_t chunk, std::uint32_t records);

  std::string path_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> chunks_;  // position, number of connections
  std::vector<StreamedConnection> connections_;
  std::map<std::uint32_t, std::vector<Run>> runs_;  // by connection number, by ascending first time
};

/// Checks the structure of a bag, with `progress` of this, and runs `use` on it. Throws as withSoundBag().
void withBagStream(const std::string& path, const std::function<void(const BagStream&)>& use,
                   const BagWalk::ReadProgress& progress = {});

}  // namespace fsr_ros
