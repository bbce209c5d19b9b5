#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/LoadFile.h>
#include <fsr_pressure_map/SetMask.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <functional>
#include <string>

#include "ros/live/live_calibration.h"

namespace fsr_ros {

/// Converts each scan on `raw` to a map on `pressure_map`, using `curvature`, `temperature` and
/// `matrix_info`. Publishes `calibration_info` (latched and repeated each second) and diagnostics. Compares
/// the surface with the sheet at rest: by itself with `chamber_pressure` and at each event doff on `events`.
/// Parameters: CalibrationSettings.
///
/// Services: `~load_calibration`, `~reload`, `~set_mask`, `~tare`, `~clear_tare`, `~check_surface`,
/// `~estimate_surface`. Each reply says what was done. The services and the first load run in a separate
/// thread, so that no scan waits for a file. If the file in `~calibration` does not exist or cannot be read,
/// the node tries again when the file changes.
class CalibrationServer {
 public:
  /// Throws fsr::InputError for parameters that cannot be used.
  CalibrationServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);
  ~CalibrationServer();

 private:
  void advertise();
  void serve();
  void subscribe();
  void onScan(const fsr_pressure_map::MatrixFrameConstPtr& scan);
  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message);
  void everySecond();
  void tryWanted();
  void onEvent(const fsr_pressure_map::EventConstPtr& event);
  void compareAtMark();
  std::string useEstimate(bool only_if_it_differs);
  void publishInfo();
  void logChange();

  bool loadCalibration(fsr_pressure_map::LoadFile::Request& request,
                       fsr_pressure_map::LoadFile::Response& response);
  std::string reload();
  bool setMask(fsr_pressure_map::SetMask::Request& request, fsr_pressure_map::SetMask::Response& response);

  ros::NodeHandle handle_;
  ros::NodeHandle private_handle_;
  CalibrationSettings settings_;
  LiveCalibration live_;
  std::string logged_ = "nothing";  // sentence about the maps that was logged last
  std::string tried_;               // fingerprint of the wanted file at the last attempt

  ros::Publisher maps_;
  ros::Publisher info_;
  ros::Subscriber scans_;
  ros::Subscriber curvature_;
  ros::Subscriber board_;
  ros::Subscriber temperature_;
  ros::Subscriber chamber_;
  ros::Subscriber events_;
  ros::Publisher estimated_;     // of the curvature, if this node is its source
  std::uint32_t estimates_ = 0;  // number of the mount that was estimated last

  diagnostic_updater::Updater diagnostics_;
  CalibrationHealth before_;  // one second before now_
  CalibrationHealth now_;
  ros::WallTimer second_;

  ros::CallbackQueue slow_queue_;  // for services and loading
  ros::WallTimer watch_;
  std::vector<ros::ServiceServer> services_;
  ros::AsyncSpinner slow_thread_;  // last: it uses everything above
};

}  // namespace fsr_ros
