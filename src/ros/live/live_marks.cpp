// Marks of the operator in LiveCalibration: `don` says that a load comes, `doff` that the sheet is unloaded
// again. A marked rest is compared as if a service had asked for it.

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/live_calibration.h"

namespace fsr_ros {

void LiveCalibration::markLoaded() {
  const std::lock_guard<std::mutex> lock(mutex_);
  worn_ = true;
  interruptRest("don was marked, so a load may be on; mark doff when it is off");
}

void LiveCalibration::markUnloaded() {
  const std::lock_guard<std::mutex> lock(mutex_);
  worn_ = false;
  rest_marked_ = true;
  marked_ = "doff: being measured";
}

std::string LiveCalibration::answerMark(const std::function<std::string()>& measure) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!rest_marked_) return "";
  rest_marked_ = false;
  lock.unlock();
  std::string sentence;
  try {
    sentence = measure();
  } catch (const fsr::settings::InputError& error) {
    sentence = error.what();
  }
  lock.lock();
  marked_ = "doff: " + sentence;
  return marked_;
}

// A window that is full already was full before.
void LiveCalibration::interruptRest(const std::string& why) {
  if (rest_asked_ && rest_full_) return;
  if (rest_asked_) {
    interruption_ = why;
    progress_.notify_all();
  }
  rest_.reset();
}

bool LiveCalibration::restAgrees() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return shape_.verdict == fsr::calibration::ShapeVerdict::kAgrees;
}

}  // namespace fsr_ros
