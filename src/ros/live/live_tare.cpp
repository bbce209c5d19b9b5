// The tare of LiveCalibration: the service waits while scans fill the measuring window.

#include <ros/console.h>

#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/live_calibration.h"
#include "settings/number_text.h"

namespace fsr_ros {

namespace fs = std::filesystem;

TareKeeper::TareKeeper(const std::string& path) {
  std::error_code failed;
  if (path.empty() || (!fs::exists(path, failed) && !failed)) return;
  try {
    tare_ = fsr::calibration::loadTare(path);
  } catch (const fsr::settings::InputError& error) {
    ROS_ERROR_STREAM("the stored tare is not used: " << error.what());
  }
}

std::vector<float> TareKeeper::review(const std::string& id, const fsr::matrix::Surface* surface) {
  if (!tare_ || id.empty()) return {};
  // A tare that was measured without curvature does not need to wait for a curvature message.
  if (fsr::calibration::holds(*tare_, id, surface != nullptr ? *surface : fsr::matrix::Surface{}))
    return tare_->offset;
  if (surface == nullptr && tare_->calibration == id) return {};
  ROS_WARN_STREAM("the tare of " << tare_->date << " is dropped: it was measured with calibration "
                                 << tare_->calibration << " on surface \"" << tare_->surface << "\", mount "
                                 << tare_->mount << ", and one of these has changed");
  drop();
  return {};
}

void TareKeeper::write(const fsr::calibration::Tare& tare, const std::string& path) {
  if (path.empty()) return;
  fsr::calibration::requireTareOrNothing(path);
  std::error_code ignored;  // an error in the folder shows when the file is written
  fs::create_directories(fs::path(path).parent_path(), ignored);
  fsr::calibration::saveTare(tare, path);
}

bool TareKeeper::drop() {
  const bool was = tare_.has_value();
  tare_.reset();
  dropped_ |= was;
  return was;
}

bool TareKeeper::remove(const std::string& path) {
  if (path.empty()) return false;
  fsr::calibration::requireTareOrNothing(path);
  std::error_code error;
  const bool removed = fs::remove(path, error);
  if (error) {
    throw fsr::settings::InputError(path +
                                    ": the tare is not used any more, but its file cannot be removed (" +
                                    error.message() + "); remove it, or it returns with the next start");
  }
  return removed;
}

namespace {

const std::string kRefusedTare = "the tare is refused: ";

fsr::settings::InputError changedMeanwhile() {
  return fsr::settings::InputError(kRefusedTare +
                                   "the calibration or the surface changed during the measurement");
}

}  // namespace

std::string LiveCalibration::tare(double patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  startTare();
  fsr::calibration::Tare tare;
  try {
    tare = measureTare(lock, patience);
  } catch (const fsr::settings::InputError& refusal) {
    measurement_.reset();
    tare_refusal_ = refusal.what();
    throw;
  } catch (...) {
    measurement_.reset();
    throw;
  }
  measurement_.reset();
  tare_refusal_.clear();
  lock.unlock();  // no scan waits for the disk
  {
    const std::lock_guard<std::mutex> files(files_);
    TareKeeper::write(tare, settings_.tare_file);
    lock.lock();
    tare_.adopt(tare);
  }
  applyTare();
  if (!tare_.tare()) throw changedMeanwhile();
  loaded_->calibrator.markRest();
  if (loaded_->shape->present()) markRest(RestMark::kTare);
  return "the sheet is tared on surface \"" + tare.surface + "\", mount " + std::to_string(tare.mount) +
         storedText(settings_.tare_file);
}

void LiveCalibration::startTare() {
  if (!loaded_) {
    throw fsr::settings::InputError(kRefusedTare + "no calibration is loaded (" + complaint_ + ")");
  }
  if (measurement_) throw fsr::settings::InputError(kRefusedTare + "another tare is being measured");
  measurement_.emplace(loaded_->calibrator.layout(), settings_.tare);
  measured_ = false;
  measured_for_ = {};
  measured_for_.calibration = id();
  measured_for_.surface = surface_.name;
  measured_for_.mount = surface_.mount;
  measured_for_.curvature = fsr::calibration::meanCurvature(surface_);
  measured_for_.size = loaded_->calibrator.layout().size;
}

fsr::calibration::Tare LiveCalibration::measureTare(std::unique_lock<std::mutex>& lock, double patience) {
  const std::uint64_t before = scans_;
  awaitScans(lock, patience, kRefusedTare, [&] {
    using fsr::map::MapState;
    const bool mismatch = map_.state == MapState::kSizeMismatch || map_.state == MapState::kWrongSensor;
    if (scans_ != before && mismatch)
      throw fsr::settings::InputError(kRefusedTare + "the board does not match the calibration");
    if (!loaded_ || !fsr::calibration::holds(measured_for_, id(), surface_)) throw changedMeanwhile();
    return measured_;
  });
  fsr::calibration::Tare tare = measured_for_;
  tare.offset =
      measurement_->offset(tare_.review(id(), surface_received_ ? &surface_ : nullptr),
                           fsr::calibration::restOfTraining(loaded_->session_zero, loaded_->calibrator));
  tare.date = fsr::settings::nowText();
  return tare;
}

std::string LiveCalibration::clearTare() {
  const std::lock_guard<std::mutex> files(files_);
  bool was = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    was = tare_.drop();
    tare_.takeDropped();
    applyTare();
  }
  const bool removed = TareKeeper::remove(settings_.tare_file);
  if (!was && !removed) return "there was no tare";
  return "the tare is cleared" + (removed ? " and its file removed: " + settings_.tare_file : "");
}

void LiveCalibration::removeDroppedTare() {
  const std::lock_guard<std::mutex> files(files_);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!tare_.takeDropped()) return;
  }
  try {
    TareKeeper::remove(settings_.tare_file);
  } catch (const fsr::settings::InputError& error) {
    ROS_WARN_STREAM(error.what());  // another file took its place
  }
}

void LiveCalibration::stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  stopping_ = true;
  progress_.notify_all();
}

}  // namespace fsr_ros
