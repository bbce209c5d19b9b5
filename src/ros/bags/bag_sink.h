#pragma once

#include <rosbag/bag.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace fsr_ros {

struct BagSinkOptions {
  std::string bag;  ///< to write, with or without .bag
  std::uint32_t chunk_size =
      1024;  ///< what a kill costs at most, beside it what the C library buffers [bytes]
  std::uint64_t least_space = 200'000'000;  ///< that stays free on the disk [bytes]
  std::uint64_t buffer = 256'000'000;       ///< for messages that the disk has not taken yet [bytes]
};

/// How a recording stands.
struct BagSinkReport {
  std::string file;            ///< FILE.bag.active, and FILE.bag once it is closed
  std::string complaint;       ///< why it ended by itself; empty = it did not
  std::uint64_t messages = 0;  ///< written
  std::uint64_t lost = 0;      ///< the buffer was full, or the recording had ended
  std::uint64_t waiting = 0;   ///< in the buffer [bytes]
  std::uint64_t space = 0;     ///< left on the disk, as seen last [bytes]
};

/// Writes a bag on a thread of its own, so that a disk that stands still holds up nobody who receives
/// messages. It is FILE.bag.active until it is closed: whole, with its index. Where the disk is nearly full
/// it is closed in time and says so; where a write fails all the same, what was written is left under
/// .active, for `rosbag reindex`.
class BagSink {
 public:
  using Write = std::function<void(rosbag::Bag&)>;

  /// Throws fsr::InputError where the bag, or what is left of a recording of that name, is there already, or
  /// where the file cannot be made. `ended`: called once, from the writing thread, where it ends by itself.
  BagSink(const BagSinkOptions& options, std::function<void(const std::string&)> ended);
  /// Writes what waits, then closes the bag.
  ~BagSink();
  BagSink(const BagSink&) = delete;
  BagSink& operator=(const BagSink&) = delete;

  /// A message of so many bytes that `write` puts into the bag; false where it is lost.
  bool add(std::uint64_t bytes, Write write);
  BagSinkReport report() const;

 private:
  struct Waiting {
    std::uint64_t bytes;
    Write write;
  };

  void run();
  bool writeAll(std::deque<Waiting>& batch);
  bool hasSpace();
  bool close();
  void end(const std::string& complaint);

  const BagSinkOptions options_;
  const std::string closed_name_;
  const std::function<void(const std::string&)> ended_;
  std::unique_ptr<rosbag::Bag> bag_;  // of the thread

  mutable std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::deque<Waiting> queue_;
  BagSinkReport report_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fsr_ros
