#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

namespace fsr::settings {

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
