#include "ros/recording/bag_sink.h"

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <chrono>
#include <filesystem>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "settings/number_text.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBatch = 256;  // messages between two checks of the space left on the disk

std::string withExtension(const std::string& bag) {
  return boost::ends_with(bag, ".bag") ? bag : bag + ".bag";
}

// A second recording under the same name would overwrite the first one. What a recorder left that died is
// closed.
void refuseExisting(const std::string& bag) {
  std::error_code error;
  std::string closed;
  if (fs::exists(bag + ".active", error)) {
    const RescuedBag rescued = rescueBag(bag + ".active");
    if (!rescued.complaint.empty()) throw fsr::settings::InputError(rescued.complaint);
    closed = "; the recording that had not been closed was closed as " + rescued.file + ", which holds " +
             std::to_string(rescued.messages) + " messages";
  }
  if (fs::exists(bag, error))
    throw fsr::settings::InputError(bag + ": a bag of this name exists" + closed + "; give another name");
}

}  // namespace

BagSink::BagSink(const BagSinkOptions& options, std::function<void(const std::string&)> ended)
    : options_(options),
      closed_name_(withExtension(options.bag)),
      ended_(std::move(ended)),
      bag_(std::make_unique<rosbag::Bag>()) {
  refuseExisting(closed_name_);
  report_.file = closed_name_ + ".active";
  lock_ = std::make_unique<RecordingLock>(report_.file, RecordingLock::Open::kNew);
  try {
    bag_->open(report_.file, rosbag::bagmode::Write);
    bag_->setChunkThreshold(options.chunk_size);
  } catch (const rosbag::BagException& error) {
    abandonBag(std::move(bag_));
    std::error_code ignored;
    fs::remove(report_.file, ignored);
    throw fsr::settings::InputError(
        report_.file + ": cannot be written (" + error.what() +
        "); give a path in a directory that exists and may be written to, on a disk with room");
  }
  thread_ = std::thread([this] { run(); });
}

BagSink::~BagSink() {
  finish();
}

void BagSink::finish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool BagSink::add(std::uint64_t bytes, Write write) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!report_.complaint.empty() || report_.waiting + bytes > options_.buffer) {
      ++report_.lost;
      return false;
    }
    report_.waiting += bytes;
    queue_.push_back({bytes, std::move(write)});
  }
  changed_.notify_all();
  return true;
}

BagSinkReport BagSink::report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return report_;
}

void BagSink::run() {
  while (true) {
    std::deque<Waiting> batch;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait_for(lock, std::chrono::seconds(1), [this] { return stopping_ || !queue_.empty(); });
      if (stopping_ && queue_.empty()) break;
      const auto end = queue_.begin() + static_cast<std::ptrdiff_t>(std::min(queue_.size(), kBatch));
      batch.assign(std::make_move_iterator(queue_.begin()), std::make_move_iterator(end));
      queue_.erase(queue_.begin(), end);
      in_hand_ = batch.size();
    }
    if (!hasSpace() || !writeAll(batch)) return;
  }
  close();
}

// Returns false if less than `least_space` is left on the disk. The bag is then closed, while there is still
// room for its index.
bool BagSink::hasSpace() {
  std::error_code error;
  const fs::space_info space = fs::space(fs::path(closed_name_ + ".active"), error);
  if (error) return true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    report_.space = space.available;
  }
  if (space.available >= options_.least_space) return true;
  if (close()) {
    end("RECORDING STOPPED: only " + fsr::settings::megabytesText(space.available) +
        " are left on the disk, less than " + fsr::settings::megabytesText(options_.least_space) + "; " +
        closed_name_ + " was closed and is complete; make room, then start a new recording");
  }
  return false;
}

bool BagSink::writeAll(std::deque<Waiting>& batch) {
  std::uint64_t bytes = 0;
  try {
    for (const Waiting& message : batch) {
      message.write(*bag_);
      bytes += message.bytes;
    }
    flushBag(*bag_);
  } catch (const rosbag::BagException& error) {
    const RescuedBag rescued = rescue();
    end("RECORDING STOPPED: " + closed_name_ + ".active cannot be written (" + error.what() + "); " +
        (rescued.complaint.empty() ? rescued.file + " was closed; make room, then start a new recording"
                                   : rescued.complaint));
    return false;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  in_hand_ = 0;
  report_.messages += batch.size();
  report_.waiting -= bytes;
  return true;
}

bool BagSink::close() {
  RescuedBag closed;
  try {
    bag_->close();
    closed.file = giveClosedName(closed_name_ + ".active");
  } catch (const std::exception&) {  // the disk is full
    closed = rescue();
  }
  lock_.reset();
  if (!closed.complaint.empty()) {
    end("the recording was NOT CLOSED: " + closed.complaint);
    return false;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.file = closed.file;
  if (closed.file != closed_name_) {
    report_.remark = closed_name_ +
                     ": another program has made a bag of this name, which was not overwritten; " +
                     "this recording is " + closed.file;
  }
  return true;
}

// Closes the bag without rosbag, which cannot go on after a failure.
RescuedBag BagSink::rescue() {
  try {
    flushBag(*bag_);  // as much as fits
  } catch (const rosbag::BagException&) {
  }
  releaseFile(std::move(bag_));
  lock_.reset();
  RescuedBag rescued;
  try {
    rescued = rescueBag(closed_name_ + ".active");
  } catch (const std::exception& error) {
    rescued = {closed_name_ + ".active", 0, error.what()};
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::uint64_t taken = report_.messages + in_hand_;
  report_.messages = std::min(taken, rescued.messages);
  in_hand_ = taken - report_.messages;
  report_.file = rescued.file;
  return rescued;
}

void BagSink::end(const std::string& complaint) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    report_.complaint = complaint;
    report_.lost += queue_.size() + in_hand_;
    report_.waiting = 0;
    queue_.clear();
  }
  if (ended_) ended_(complaint);
}

}  // namespace fsr_ros
