// Marks of the operator in LiveCalibration: `don` says that a load comes, `doff` and a tare that the sheet is
// unloaded. A marked rest is compared as if a service had asked for it.

#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/live_calibration.h"

namespace fsr_ros {

namespace {

std::string nameOf(RestMark mark) {
  return mark == RestMark::kTare ? "tare" : "doff";
}

}  // namespace

void LiveCalibration::markLoaded() {
  const std::lock_guard<std::mutex> lock(mutex_);
  worn_ = true;
  interruptRest("don was marked, so a load may be on; mark doff when it is off");
}

void LiveCalibration::markUnloaded() {
  const std::lock_guard<std::mutex> lock(mutex_);
  worn_ = false;
  markRest(RestMark::kDoff);
}

void LiveCalibration::markRest(RestMark mark) {
  rest_marked_ = mark;
  marked_ = nameOf(mark) + ": being measured";
}

std::string LiveCalibration::answerMark(const std::function<std::string(RestMark)>& measure) {
  std::unique_lock<std::mutex> lock(mutex_);
  const RestMark mark = std::exchange(rest_marked_, RestMark::kNone);
  if (mark == RestMark::kNone) return "";
  lock.unlock();
  std::string sentence;
  try {
    sentence = measure(mark);
  } catch (const fsr::settings::InputError& error) {
    sentence = error.what();
  }
  lock.lock();
  marked_ = nameOf(mark) + ": " + sentence;
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
