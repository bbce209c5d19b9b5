#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <fsr_pressure_map/LoadFile.h>
#include <fsr_pressure_map/SetMask.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>

#include "ros/live/live_calibration.h"

namespace fsr_ros {

/// Turns `raw` into `pressure_map` scan by scan, with the help of `curvature` and `matrix_info`; publishes
/// `calibration_info` (latched and repeated each second) and diagnostics. Parameters: CalibrationSettings.
///
/// Services, each of which says what was done: `~load_calibration`, `~reload`, `~set_mask`, `~tare`,
/// `~clear_tare`. They run in a thread of their own, as does the first load: no scan waits for a file. A file
/// that is named by `~calibration` and is not there yet, or not sound, is tried again when it changes.
class CalibrationServer {
 public:
  /// Throws fsr::InputError for parameters that cannot be used.
  CalibrationServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);
  ~CalibrationServer();

 private:
  using Trigger = std_srvs::Trigger;

  void advertise();
  void serve();
  void subscribe();
  void onScan(const fsr_pressure_map::MatrixFrameConstPtr& scan);
  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message);
  void everySecond();
  void tryWanted();
  void publishInfo();
  void logChange();

  bool loadCalibration(fsr_pressure_map::LoadFile::Request& request,
                       fsr_pressure_map::LoadFile::Response& response);
  bool reload(Trigger::Request& request, Trigger::Response& response);
  bool setMask(fsr_pressure_map::SetMask::Request& request, fsr_pressure_map::SetMask::Response& response);
  bool tare(Trigger::Request& request, Trigger::Response& response);
  bool clearTare(Trigger::Request& request, Trigger::Response& response);

  ros::NodeHandle handle_;
  ros::NodeHandle private_handle_;
  CalibrationSettings settings_;
  LiveCalibration live_;
  std::string logged_ = "nothing";  // what the log last said of the maps
  std::string tried_;               // the wanted file as it was when it was last tried

  ros::Publisher maps_;
  ros::Publisher info_;
  ros::Subscriber scans_;
  ros::Subscriber curvature_;
  ros::Subscriber board_;

  diagnostic_updater::Updater diagnostics_;
  CalibrationHealth before_;  // as the last diagnostics saw it
  CalibrationHealth now_;
  ros::WallTimer second_;

  ros::CallbackQueue slow_queue_;  // of services and loading
  ros::WallTimer watch_;
  std::vector<ros::ServiceServer> services_;
  ros::AsyncSpinner slow_thread_;  // last: it uses everything above
};

}  // namespace fsr_ros
