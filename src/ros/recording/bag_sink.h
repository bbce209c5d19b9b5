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

#include "ros/bags/rescue_bag.h"

namespace fsr_ros {

struct BagSinkOptions {
  std::string bag;  ///< file to write, with or without .bag
  /// Largest amount of data that `rosbag reindex` leaves out of a bag that was not closed [bytes].
  std::uint32_t chunk_size = 1024;
  std::uint64_t least_space = 200'000'000;  ///< space that stays free on the disk [bytes]
  std::uint64_t buffer = 256'000'000;  ///< size of the queue of messages that are not written yet [bytes]
};

/// State of a recording.
struct BagSinkReport {
  std::string file;            ///< FILE.bag.active; FILE.bag after it is closed
  std::string complaint;       ///< why the recording stopped by itself; empty = it did not
  std::string remark;          ///< why the closed bag has another name than it was given; empty = it has not
  std::uint64_t messages = 0;  ///< messages written
  std::uint64_t lost = 0;      ///< messages lost: the queue was full, or the recording had stopped
  std::uint64_t waiting = 0;   ///< size of the queue [bytes]
  std::uint64_t space = 0;     ///< space left on the disk at the last check [bytes]
};

/// Writes a bag in its own thread, so that a slow disk does not delay the thread that receives messages. The
/// file is called FILE.bag.active until it is closed and has its index. If another bag has taken the name
/// FILE.bag meanwhile, it is called FILE_2.bag. When the disk is nearly full, the bag
/// is closed in time and the recording stops. When a write fails, or the bag cannot be closed, no message
/// that was counted as written is lost (rescueBag()). Every message that was added is counted either as
/// written or as lost.
class BagSink {
 public:
  using Write = std::function<void(rosbag::Bag&)>;

  /// Closes what is left of a recording of that name. Throws fsr::InputError if that fails, if the bag exists
  /// already, or if the file cannot be created. `ended` is called once, from the writing thread, if the
  /// recording stops by itself.
  BagSink(const BagSinkOptions& options, std::function<void(const std::string&)> ended);
  /// Writes the messages in the queue, then closes the bag.
  ~BagSink();
  /// Writes the messages in the queue and closes the bag, before the destructor does. Call it once at the
  /// end.
  void finish();
  BagSink(const BagSink&) = delete;
  BagSink& operator=(const BagSink&) = delete;

  /// Queues a message of `bytes` bytes, which `write` will write to the bag. Returns false if it is lost.
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
  RescuedBag rescue();
  void end(const std::string& complaint);

  const BagSinkOptions options_;
  const std::string closed_name_;
  const std::function<void(const std::string&)> ended_;
  std::unique_ptr<RecordingLock> lock_;
  std::unique_ptr<rosbag::Bag> bag_;  // both are used by the writing thread only

  mutable std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  std::deque<Waiting> queue_;
  std::size_t in_hand_ = 0;  // messages that were taken off the queue, but are not written yet
  BagSinkReport report_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fsr_ros
