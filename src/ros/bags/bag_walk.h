#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace fsr_ros {

/// A connection of a bag: topic and message type of one publisher.
struct BagConnection {
  std::string topic, type, md5sum;
  std::string definition;  ///< of the message type, as text
};

/// A serialised message, in memory that belongs to the walk.
struct MessageBytes {
  std::uint8_t* data;
  std::uint32_t size;
  std::uint32_t seconds = 0, nanoseconds = 0;  ///< time of reception
};

/// Reads the records of a bag once, from its beginning to its end. rosbag trusts every length and offset in
/// the file, and a wrong one makes it read outside of its memory. This class checks each of them before it is
/// used.
///
/// Throws rosbag::BagUnindexedException if the bag was not closed, and another rosbag::BagException if the
/// records do not fill the file without gaps, if an index entry does not point to a message of its
/// connection, or if a chunk cannot be unpacked. Memory: one chunk of the bag, and some bytes for each of its
/// messages.
class BagWalk {
 public:
  /// Reads the index at the file's end.
  explicit BagWalk(const std::string& path);

  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }

  /// Number of messages of a topic, as the index says.
  std::uint64_t messages(const std::string& topic) const;
  /// Size of the file.
  std::uint64_t bytes() const { return bytes_; }

  /// Is called now and then with the share of the file that was read.
  using ReadProgress = std::function<void(double share)>;

  /// Is called with each message and the number of its connection. The bytes are valid during the call only.
  using Visit = std::function<void(std::uint32_t connection, MessageBytes message)>;

  /// Calls `visit` for every message in the index, in the order of the file. Returns the SHA-256 of the file.
  std::string run(const Visit& visit, const ReadProgress& progress = {}) const;

 private:
  void addCounts(std::string_view data);

  std::string path_;
  std::uint64_t bytes_ = 0;
  std::map<std::uint32_t, BagConnection> connections_;
  std::map<std::uint32_t, std::uint64_t> messages_;  // by connection
};

/// Progress of reading as a step of a tool; none where nobody asks.
BagWalk::ReadProgress told(const std::string& step,
                           const std::function<void(const std::string& step, double share)>& progress);

/// Checks the structure of a bag before rosbag opens it. Throws as BagWalk does.
void requireSoundBag(const std::string& path, const BagWalk::ReadProgress& progress = {});

}  // namespace fsr_ros
