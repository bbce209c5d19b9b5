#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ros/live/parameters.h"
#include "ros/recording/bag_sink.h"

namespace fsr_ros {

/// Counts the scans of a recording.
class ScanTally {
 public:
  void add(const fsr_pressure_map::MatrixFrame& scan);

  std::uint64_t scans() const { return scans_; }
  /// "412 scans in 41.2 s (3 lost by the board's counter)".
  std::string text() const;

 private:
  std::uint64_t scans_ = 0;
  std::uint64_t lost_ = 0;
  std::uint32_t sequence_ = 0;  // of the last scan
  double first_ = 0;            // stamp [s]
  double last_ = 0;             // stamp [s]
};

/// Records topics of any type into one bag, as `rosbag record` does, but loses less. The queue of each topic
/// holds ten seconds at 1 kHz (rosbag: a tenth of a second). When the disk is full, the bag is closed. An
/// older recording is never overwritten. Diagnostics report the messages written and lost. If recording
/// stops, the node logs the reason and ends.
///
/// With `~scans` (topics of scans, one for each sheet) the node ends with an error where no scan has come
/// `~wait` [s] after the start, and reports an error while scans of any sheet fail to come, or where two
/// sheets have boards of one serial number. It says at the end what was recorded.
///
/// Parameters: `~bag`, `~topics` (names, separated by spaces), `~scans` (likewise), `~wait` [s], `~surface`
/// and
/// `~surfaces` (checked at the start, as are the parameters of the session node if there are any),
/// `~chunk_kb`, `~min_space` [MB], `~buffer` [MB].
class Recorder {
 public:
  /// `ended` is called, perhaps from another thread, where the recording stops by itself; empty = the node
  /// ends. Throws fsr::InputError.
  Recorder(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
           std::function<void()> ended = {});
  /// Closes the bag and prints what was recorded.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Writes what was received and closes the bag.
  void finish();

  /// The bag, under its name of now.
  std::string file() const { return sink_->report().file; }

  /// Why the recording stopped by itself; empty = it did not.
  std::string complaint() const { return sink_->report().complaint; }

  /// Whether the bag has its name and its index. Ask after finish().
  bool closed() const;

  /// Whether the recording stopped by itself, or could not be closed.
  bool failed() const { return failed_; }

 private:
  void subscribe(const std::string& topic);
  void judge(diagnostic_updater::DiagnosticStatusWrapper& status);
  void watchScans();
  void refuse();
  void keepSerial(const std::string& topic, const fsr_pressure_map::MatrixInfo& info);
  std::string whyNoScan() const;
  std::string missingTopics() const;

  ros::NodeHandle handle_;
  const std::function<void()> ended_;
  std::atomic<bool> failed_{false};
  std::atomic<std::uint64_t> without_time_{0};  // messages received before the first /clock
  std::unique_ptr<BagSink> sink_;
  struct Scans {
    ScanTally tally;
    double last = 0;      // when the last scan came, or the recording began (monotonic clock [s])
    bool silent = false;  // no scan has come for a while
  };
  std::map<std::string, Scans> scans_;             // by topic; empty = no scans are expected
  std::map<std::string, std::string> serials_;     // of the boards, by the namespace of the sheet
  double wait_ = 0;                                // [s]
  std::map<std::string, std::uint64_t> received_;  // messages of each topic
  double start_ = 0;                               // (monotonic clock [s])
  bool looked_ = false;                            // at the topics on which nothing has come
  bool refused_ = false;
  diagnostic_updater::Updater diagnostics_;
  BagSinkReport before_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
};

}  // namespace fsr_ros
