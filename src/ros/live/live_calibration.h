#pragma once

#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SurfaceCurvature.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "ros/bags/loaded_calibration.h"
#include "ros/live/calibration_settings.h"
#include "ros/live/tare_keeper.h"

namespace fsr_ros {

/// How the calibration node stood at one moment, as far as diagnostics are concerned.
struct CalibrationHealth {
  std::string complaint;                   ///< why no calibration is loaded, or why the last load failed
  std::string surface_complaint;           ///< what is wrong with the last curvature message; empty = nothing
  fsr_pressure_map::CalibrationInfo info;  ///< id empty = none loaded
  fsr::matrix::Surface surface;
  std::string board;  ///< serial number; empty = unknown
  std::optional<fsr::calibration::Tare> tare;
  std::uint64_t scans = 0;
  std::uint64_t revivals = 0;  ///< taxels that came back to life
  fsr::map::PressureMap map;   ///< the last one
};

/// The calibration node without its topics: what it was told and what follows for each scan. Every method may
/// be called from any thread; none keeps scans waiting for longer than a copy.
class LiveCalibration {
 public:
  explicit LiveCalibration(const CalibrationSettings& settings);

  /// Fills the map of one scan, header included.
  void calibrate(const fsr_pressure_map::MatrixFrame& scan, fsr_pressure_map::PressureMap& map);
  void setSurface(const fsr_pressure_map::SurfaceCurvature& message);
  void setBoard(const fsr_pressure_map::MatrixInfo& message);

  // What services ask for: each returns a sentence that says what was done, or throws fsr::InputError.

  /// Reads a file and, where it is sound, puts it in the old calibration's place.
  std::string load(const std::string& path);
  /// load() of the file in use, or else of the one that was last asked for.
  std::string reload();
  /// In addition to the mask of the board.
  std::string setMask(const std::vector<std::uint8_t>& mask);
  /// Waits until the window of the tare is full; refused where no scan comes for `patience` [s].
  std::string tare(double patience);
  std::string clearTare();

  /// The file that is wanted and not loaded; empty where there is none.
  std::string wanted() const;
  fsr_pressure_map::CalibrationInfo info() const;
  CalibrationHealth health() const;

  /// Ends a waiting tare(), for good.
  void stop();

 private:
  void applySurface();
  void applyMask();
  void applyBoard();
  void applyTare();
  std::string id() const { return loaded_ ? loaded_->info.id : std::string(); }
  void startTare();
  fsr::calibration::Tare measureTare(std::unique_lock<std::mutex>& lock, double patience);
  void awaitWindow(std::unique_lock<std::mutex>& lock, double patience);

  const CalibrationSettings settings_;
  mutable std::mutex mutex_;  // over all that follows
  std::unique_ptr<LoadedCalibration> loaded_;
  std::string wanted_path_;
  std::string complaint_;
  std::string surface_complaint_;

  bool surface_received_ = false;
  fsr::matrix::Surface surface_;
  double surface_time_ = 0;  // [s]
  fsr_pressure_map::MatrixInfo board_;
  std::vector<std::uint8_t> mask_;  // by service

  TareKeeper tare_;
  std::optional<fsr::calibration::TareMeasurement> measurement_;  // while tare() waits
  fsr::calibration::Tare measured_for_;                           // what must stay the same meanwhile
  bool measured_ = false;
  bool stopping_ = false;
  std::condition_variable progress_;  // a map came, or the end

  fsr::map::PressureMap map_;
  std::uint64_t scans_ = 0;
};

}  // namespace fsr_ros
