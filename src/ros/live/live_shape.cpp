// How the sheet lies, in LiveCalibration: services wait while scans of the unloaded sheet fill a window. In a
// chamber at ambient the surface is compared once without being asked.
//
// Marks of the operator: `don` says that a load comes, `doff` and a tare that the sheet is
// unloaded. A marked rest is compared as if a service had asked for it.

#include <cmath>
#include <utility>

#include "dataset/recording_builder.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/live_calibration.h"

namespace fsr_ros {

namespace {

const std::string kRefused = "how the sheet lies cannot be told: ";

}  // namespace

void LiveCalibration::setChamber(double absolute) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const double gauge =
      absolute - (board_.ambient_pressure > 0 ? board_.ambient_pressure : fsr::dataset::kStandardAmbient);
  ambient_ = std::abs(gauge) <= fsr::calibration::kUnloaded;
  if (!ambient_) {
    load_seen_ = true;
    interruptRest("the chamber left ambient pressure");
  }
  startComparison();
}

// A window that nobody asked for: only before the first load, because a sheet creeps back after one.
void LiveCalibration::startComparison() {
  if (rest_ || !loaded_ || !loaded_->shape->present() || !surface_.known()) return;
  if (!ambient_ || load_seen_ || worn_ || !shape_.sentence.empty()) return;
  rest_.emplace(*loaded_->shape, settings_.tare);
  rest_full_ = false;
}

void LiveCalibration::forgetShape() {
  shape_ = {};
  if (!settings_.estimates_curvature) marked_.clear();  // else it says what this node made of it
  load_seen_ = false;
  if (!rest_asked_) rest_.reset();
}

void LiveCalibration::watchShape(const fsr::matrix::ScanView& scan, double time) {
  if (!rest_ || rest_full_) return;
  constexpr std::uint16_t kUnsound = fsr::map::taxel_flag::kDead | fsr::map::taxel_flag::kStuck |
                                     fsr::map::taxel_flag::kMasked | fsr::map::taxel_flag::kLineFault;
  ignored_.assign(map_.flags.size(), 0);
  for (std::size_t t = 0; t < ignored_.size(); ++t) ignored_[t] = (map_.flags[t] & kUnsound) != 0 ? 1 : 0;
  rest_full_ = rest_->add(scan, ignored_, time);
  if (rest_full_) progress_.notify_all();
}

// Why the sheet cannot be compared now; empty = it can. `loaded_` must be set.
std::string LiveCalibration::obstacleToShape() const {
  const fsr_pressure_map::CalibrationInfo& info = loaded_->info;
  const std::string sensor = fsr::calibration::sensorObstacle(board_.serial, info.sensor_serial);
  if (!sensor.empty()) return sensor;
  return fsr::calibration::temperatureObstacle(temperature_, info.temperature_low, info.temperature_high);
}

void LiveCalibration::compareAtRest() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!rest_ || !rest_full_ || rest_asked_ || !loaded_) return;
  const fsr::matrix::Surface surface = surface_;
  const std::shared_ptr<const fsr::calibration::ShapeModel> model = loaded_->shape;
  fsr::calibration::ShapeCheck check;
  try {
    const std::string obstacle = obstacleToShape();
    if (!obstacle.empty()) throw fsr::settings::InputError(kRefused + obstacle);
    const fsr::calibration::RestReading reading = rest_->reading();
    rest_.reset();
    lock.unlock();  // no scan waits for the comparison
    check = fsr::calibration::checkShape(*model, reading, surface);
    lock.lock();
  } catch (const fsr::settings::InputError& error) {
    rest_.reset();
    check.sentence = error.what();
  }
  if (fsr::matrix::sameCondition(surface, surface_) && loaded_ && loaded_->shape == model) shape_ = check;
}

fsr::calibration::ShapeCheck LiveCalibration::measureShape(double patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!loaded_) throw fsr::settings::InputError(kRefused + "no calibration is loaded (" + complaint_ + ")");
  if (!loaded_->shape->present()) throw fsr::settings::InputError(kRefused + loaded_->shape->missing);
  const std::string obstacle = obstacleToShape();
  if (!obstacle.empty()) throw fsr::settings::InputError(kRefused + obstacle);
  if (!ambient_ && load_seen_)
    throw fsr::settings::InputError(kRefused + "the chamber is not at ambient pressure; unload the sheet");
  if (worn_)
    throw fsr::settings::InputError(kRefused +
                                    "don was marked, so a load may be on; mark doff when it is off");
  if (rest_asked_) throw fsr::settings::InputError(kRefused + "another call is measuring");
  const std::shared_ptr<const fsr::calibration::ShapeModel> model = loaded_->shape;
  rest_.emplace(*model, settings_.tare);
  rest_full_ = false;
  rest_asked_ = true;
  interruption_.clear();
  fsr::calibration::RestReading reading;
  try {
    reading = awaitRest(lock, patience);
  } catch (...) {
    rest_asked_ = false;
    rest_.reset();
    throw;
  }
  rest_asked_ = false;
  rest_.reset();
  const fsr::matrix::Surface surface = surface_;
  lock.unlock();
  const fsr::calibration::ShapeCheck check = fsr::calibration::checkShape(*model, reading, surface);
  lock.lock();
  if (fsr::matrix::sameCondition(surface, surface_)) shape_ = check;
  marked_.clear();
  return check;
}

fsr::calibration::RestReading LiveCalibration::awaitRest(std::unique_lock<std::mutex>& lock,
                                                         double patience) {
  awaitScans(lock, patience, kRefused, [&] { return rest_full_ || !interruption_.empty(); });
  if (!interruption_.empty()) throw fsr::settings::InputError(kRefused + interruption_);
  return rest_->reading();
}

std::string LiveCalibration::checkSurface(double patience) {
  const fsr::calibration::ShapeCheck check = measureShape(patience);
  if (check.verdict == fsr::calibration::ShapeVerdict::kUnknown && !check.estimated)
    throw fsr::settings::InputError(check.sentence);
  return check.sentence;
}

fsr::matrix::Surface LiveCalibration::estimateSurface(double patience, std::string& sentence) {
  const fsr::calibration::ShapeCheck check = measureShape(patience);
  if (!check.estimated) {
    throw fsr::settings::InputError(check.verdict == fsr::calibration::ShapeVerdict::kUnknown
                                        ? check.sentence
                                        : fsr::calibration::openText(check.estimate));
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!loaded_ || !loaded_->shape->one_direction) {
    throw fsr::settings::InputError(
        kRefused +
        "training bent the sheet in several directions, which its readings at rest do "
        "not tell apart");
  }
  const fsr::matrix::Curvature& direction = loaded_->shape->direction;
  const double k = check.estimate.curvature;
  fsr::matrix::Surface surface;
  surface.name = "estimated";
  surface.curvature = {{k * direction.x, k * direction.y, k * direction.xy}};
  surface.deviation = {check.estimate.deviation};
  sentence = check.sentence;
  return surface;
}

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
