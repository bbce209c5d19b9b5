#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace fsr_ros {

/// What a bag says of the messages of one topic and publisher.
struct BagConnection {
  std::string topic, type, md5sum;
};

/// A serialised message, where it stands in the walk's own memory.
struct MessageBytes {
  std::uint8_t* data;
  std::uint32_t size;
};

/// Walks a bag's records from end to end, once. rosbag believes every length and offset in the file, and one
/// that is wrong makes it read outside of its memory; here each is looked at before it is used.
///
/// Throws rosbag::BagUnindexedException where the bag was not closed, and another rosbag::BagException where
/// records do not tile the file, an index points elsewhere than at a message of its connection, or a chunk
/// cannot be unpacked. Memory: one chunk of the bag, and some bytes for each of its messages.
class BagWalk {
 public:
  /// Reads the index at the file's end.
  explicit BagWalk(const std::string& path);

  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }

  /// Takes a message of the connection of this number; a message is good until the visit ends.
  using Visit = std::function<void(std::uint32_t connection, MessageBytes message)>;

  /// Hands over every message that the index names, in the order of the file. Returns the SHA-256 of the
  /// file's bytes.
  std::string run(const Visit& visit) const;

 private:
  std::string path_;
  std::map<std::uint32_t, BagConnection> connections_;
};

/// Walks the bag and leaves its messages alone: before rosbag opens it. Throws likewise.
void requireSoundBag(const std::string& path);

}  // namespace fsr_ros
