#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <ostream>
#include <string>
#include <utility>

namespace fsr::settings {

/// Tells the user of a tool how far it is and how long it will still take. A terminal shows one line that
/// is overwritten, after two seconds and four times a second at most; it disappears at the end. A file gets a
/// line every minute.
class Progress {
 public:
  using Clock = std::function<double()>;  ///< [s]

  /// `terminal`: whether `out` is one.
  Progress(std::ostream& out, bool terminal, Clock clock);
  /// To stderr, by the computer's clock.
  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Removes the line.
  ~Progress();

  /// `share` of the work that is done, 0 to 1; `step`: what is being done. The time left is that of all steps
  /// over which the share rises; where it falls, other work begins.
  void report(const std::string& step, double share);
  /// Removes the line, so that other output may follow.
  void clear();

 private:
  std::ostream& out_;
  const bool terminal_;
  const Clock clock_;
  double shown_;      // when the last line was written [s]
  double began_ = 0;  // the work [s]
  double first_share_ = 0, last_share_ = 2;
  bool open_ = false;  // a line stands on the terminal
};

/// "42 s", "3 min", "2.5 h".
std::string durationText(double seconds);

/// Counts the parts of a step of some work that are done, on several threads, and tells the user.
class StepProgress {
 public:
  /// Called by one thread at a time. `share`: of the step that is done, 0 to 1.
  using Tell = std::function<void(const std::string& step, double share)>;

  /// `tell` must outlive the object; empty = nobody asks.
  StepProgress(const Tell& tell, std::string step, std::size_t parts)
      : tell_(tell), step_(std::move(step)), parts_(parts) {
    if (tell_) tell_(step_, 0);
  }
  void partDone() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (tell_) tell_(step_, static_cast<double>(++done_) / static_cast<double>(parts_));
  }

 private:
  const Tell& tell_;
  std::string step_;
  std::size_t parts_, done_ = 0;
  std::mutex mutex_;
};

}  // namespace fsr::settings
