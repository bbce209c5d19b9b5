#pragma once

#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/node_handle.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/stages/session/tare.h"
#include "calibration/stages/shape/mounted_rests.h"
#include "calibration/stages/shape/shape_check.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "ros/bags/loaded_calibration.h"
#include "ros/live/parameters.h"

namespace fsr_ros {

/// Stores the mask of ~set_mask [one value for each taxel, row-major, 1 = masked], so that it survives a
/// restart of the node. An empty path stands for no file. Throws fsr::InputError, also if the file that is
/// there is no mask.
void saveMask(const std::vector<std::uint8_t>& mask, const std::string& path);

/// Reads it again; empty if there is no file. Throws fsr::InputError.
std::vector<std::uint8_t> loadMask(const std::string& path);

/// The tare in use, and its file, with which it survives a restart of the node. The tare is dropped when the
/// calibration, the surface or the mount changes. Only the static functions and the constructor touch the
/// file, which may take long. An empty path stands for no file.
class TareKeeper {
 public:
  /// Reads the tare that an earlier run stored. If the file cannot be read, logs an error and leaves the
  /// file.
  explicit TareKeeper(const std::string& path);

  /// The offset to subtract from each taxel, row-major [Pa]; empty = none. The tare is not used yet while no
  /// calibration is loaded (`id` empty) or no curvature has come (`surface` nullptr). It is dropped if
  /// calibration, surface or mount are not those it was measured with.
  std::vector<float> review(const std::string& id, const fsr::matrix::Surface* surface);

  /// Writes the file of a tare without using the tare. Throws fsr::InputError, also if the file that is there
  /// is no tare.
  static void write(const fsr::calibration::Tare& tare, const std::string& path);
  /// Uses a tare that was written.
  void adopt(const fsr::calibration::Tare& tare) {
    tare_ = tare;
    dropped_ = false;
  }

  /// Drops the tare; its file is there until remove(). Returns false if there was none.
  bool drop();
  /// Whether a tare was dropped since the last call, and none was adopted: its file is to be removed.
  bool takeDropped() { return std::exchange(dropped_, false); }
  /// Removes the file of a tare that is not used any more. Returns false if there is none. Throws
  /// fsr::InputError if the file is something else or cannot be removed.
  static bool remove(const std::string& path);

  const std::optional<fsr::calibration::Tare>& tare() const { return tare_; }

 private:
  std::optional<fsr::calibration::Tare> tare_;
  bool dropped_ = false;
};

/// Parameters of the calibration node and their defaults.
struct CalibrationSettings {
  std::string calibration;  ///< resolved path; empty = wait for ~load_calibration
  fsr::calibration::CalibratorOptions
      calibrator;  ///< ~class_hysteresis, ~curvature_step, ~curvature_timeout, ~temperature_margin,
                   ///< ~fill_bad_taxels
  fsr::calibration::TareOptions tare;  ///< ~tare_limit, ~tare_scatter, ~tare_window
  std::string tare_file;               ///< resolved path; empty = nothing is read or stored (~remember)
  std::string mask_file;               ///< likewise
  bool estimates_curvature = false;    ///< ~curvature is "estimated": this node publishes it
  double contact_threshold = 10e3;     ///< diagnostics count a taxel as in contact from this pressure on [Pa]
  std::uint32_t queue_size =
      10000;  ///< length of the queues of scans and maps [messages]: ten seconds at 1 kHz
};

/// Reads and checks the private parameters. Throws fsr::InputError.
CalibrationSettings readCalibrationSettings(const ros::NodeHandle& private_handle);

/// A sample of the calibration node's state, for diagnostics.
struct CalibrationHealth {
  std::string complaint;                   ///< why no calibration is loaded, or why the last load failed
  std::string surface_complaint;           ///< what is wrong with the last curvature message; empty = nothing
  fsr_pressure_map::CalibrationInfo info;  ///< id empty = none loaded
  std::string deviation;                   ///< LoadedCalibration::deviation
  fsr::matrix::Surface surface;
  std::string board;                  ///< serial number; empty = unknown
  bool corrects_temperature = false;  ///< the calibration has a model of the temperature
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< [degree Celsius]; NaN = unknown
  std::optional<fsr::calibration::Tare> tare;
  std::string tare_refusal;  ///< why the last tare on this surface was refused; empty = none was
  fsr::calibration::SessionZero session_zero;  ///< of the calibration in use
  fsr::calibration::ShapeCheck shape;          ///< of the surface in use; sentence empty = not compared yet
  std::string marked;                ///< what was done at the last marked rest; empty = none was marked
  std::string no_shape;              ///< why nothing can be compared with this calibration; empty = it can
  bool estimates_curvature = false;  ///< this node publishes the curvature
  std::uint64_t scans = 0;
  std::uint64_t revivals = 0;  ///< dead taxels that recovered
  fsr::map::PressureMap map;   ///< the last map
};

/// What says that the sheet is unloaded.
enum class RestMark { kNone, kDoff, kTare };

/// The calibration node without its topics: holds calibration, surface, board, mask and tare, and applies
/// them to each scan. Every method may be called from any thread. None delays a scan for longer than it takes
/// to copy data.
class LiveCalibration {
 public:
  explicit LiveCalibration(const CalibrationSettings& settings);

  /// Fills the map of one scan, header included.
  void calibrate(const fsr_pressure_map::MatrixFrame& scan, fsr_pressure_map::PressureMap& map);
  void setSurface(const fsr_pressure_map::SurfaceCurvature& message);
  void setTemperature(double temperature);  ///< [degree Celsius]
  void setBoard(const fsr_pressure_map::MatrixInfo& message);

  // Actions of the services. Each returns a sentence that says what was done, or throws fsr::InputError.

  /// Reads a calibration file and, if it is valid, replaces the calibration in use.
  std::string load(const std::string& path);
  /// Loads the file in use again, or the file that was requested last if none is in use.
  std::string reload();
  /// Masks taxels in addition to those that the board masks.
  std::string setMask(const std::vector<std::uint8_t>& mask);
  /// Measures a tare; waits until its window is full. Refused if no scan comes for `patience` [s].
  std::string tare(double patience);
  std::string clearTare();
  /// Removes the file of a tare that was dropped because calibration, surface or mount changed; to be called
  /// again and again from a thread that may wait.
  void removeDroppedTare();

  /// Compares the surface with the sheet, which must be unloaded; waits for a window of scans as tare().
  std::string checkSurface(double patience);
  /// Likewise, and gives the surface as the sheet tells it. Throws if it cannot be told. `sentence`: what was
  /// found.
  fsr::matrix::Surface estimateSurface(double patience, std::string& sentence);
  /// The gauge pressure of a chamber round the sheet [Pa]. While it is at ambient and no load has come since
  /// the sheet was laid on its surface, the surface is compared once.
  void setChamber(double absolute);
  /// The operator says that a load comes (event don): nothing is compared from now on.
  void markLoaded();
  /// The operator says that the sheet is unloaded (event doff), until markLoaded().
  void markUnloaded();
  /// Calls `measure`, which is checkSurface() or uses estimateSurface(), if the sheet was marked as unloaded
  /// or tared since the last call. Returns a sentence on what was done for diagnostics; empty without a mark.
  std::string answerMark(const std::function<std::string(RestMark)>& measure);
  /// The last comparison found that the sheet rests as the surface says.
  bool restAgrees() const;
  /// Does the slow part of the comparison in a chamber; to be called again and again from a thread that may
  /// wait.
  void compareAtRest();

  /// The file that was requested, but is not loaded; empty if there is none.
  std::string wanted() const;
  fsr_pressure_map::CalibrationInfo info() const;
  CalibrationHealth health() const;

  /// Ends a waiting tare(). Later calls of tare() are refused.
  void stop();

 private:
  void applySurface();
  void applyMask();
  std::size_t maskedTaxels() const;
  void applyBoard();
  void applyTare();
  static std::string storedText(const std::string& file);
  std::string id() const { return loaded_ ? loaded_->info.id : std::string(); }
  void startTare();
  fsr::calibration::Tare measureTare(std::unique_lock<std::mutex>& lock, double patience);
  void awaitScans(std::unique_lock<std::mutex>& lock, double patience, const std::string& refused,
                  const std::function<bool()>& done);
  void watchShape(const fsr::matrix::ScanView& scan, double time);
  void forgetShape();
  void startComparison();
  std::string obstacleToShape() const;
  void interruptRest(const std::string& why);
  void markRest(RestMark mark);
  fsr::calibration::ShapeCheck measureShape(double patience);
  fsr::calibration::RestReading awaitRest(std::unique_lock<std::mutex>& lock, double patience);

  const CalibrationSettings settings_;
  std::mutex files_;          // guards the files of tare and mask; locked before mutex_
  mutable std::mutex mutex_;  // guards the following members
  std::unique_ptr<LoadedCalibration> loaded_;
  std::string wanted_path_;
  std::string complaint_;
  std::string surface_complaint_;

  bool surface_received_ = false;
  fsr::matrix::Surface surface_;
  double surface_time_ = 0;                                        // [s]
  double temperature_ = std::numeric_limits<double>::quiet_NaN();  // [degree Celsius]
  fsr_pressure_map::MatrixInfo board_;
  std::vector<std::uint8_t> mask_;  // set by the service, or stored by it

  TareKeeper tare_;
  std::string tare_refusal_;                                      // of the last tare on this surface
  std::optional<fsr::calibration::TareMeasurement> measurement_;  // set while tare() waits
  fsr::calibration::Tare measured_for_;  // calibration and surface, which must not change meanwhile
  bool measured_ = false;
  bool stopping_ = false;
  std::condition_variable progress_;  // notified by a new map, and by stop()

  // The comparison of the surface with the sheet at rest, see live_shape.cpp.
  std::optional<fsr::calibration::RestWindow> rest_;  // scans are being collected
  bool rest_full_ = false;
  bool rest_asked_ = false;                 // by a service, which waits
  bool ambient_ = false;                    // the chamber is at ambient
  bool load_seen_ = false;                  // since the sheet was laid on its surface
  bool worn_ = false;                       // don was marked, and no doff since
  RestMark rest_marked_ = RestMark::kNone;  // not answered yet
  std::string marked_;                      // what was done at the last mark
  std::string interruption_;                // why a window that a service waits for is not at rest
  fsr::calibration::ShapeCheck shape_;
  std::vector<std::uint8_t> ignored_;  // taxels of the last map without a sound reading

  fsr::map::PressureMap map_;
  std::uint64_t scans_ = 0;
};

}  // namespace fsr_ros
