#include "ros/live/tare_keeper.h"

#include <ros/console.h>

#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"

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

}  // namespace fsr_ros
