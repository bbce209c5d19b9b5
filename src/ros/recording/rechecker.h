#pragma once

#include <ros/ros.h>
#include <sensor_msgs/FluidPressure.h>

#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "check/check.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "report/check_report.h"
#include "ros/recording/recorder.h"

namespace fsr_ros {

/// Rechecks a calibration on one surface: records until enough cycles of the chamber have passed, or takes
/// bags that exist, and writes a corrected calibration where that wins. See recheck.launch and
/// docs/check.md.
///
/// Parameters: `~calibration` (empty = that of the calibration node), `~output` (empty = beside it),
/// `~report`, `~same_mount`, `~bags` (separated by spaces; empty = record), `~bag`, `~cycles`,
/// `~ambient_pressure` [Pa], `~wait` [s],
/// `~min_space` [MB].
class Rechecker {
 public:
  /// Throws fsr::InputError.
  Rechecker(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

  /// Records, until there are enough cycles or ROS ends, and rechecks. The result is printed to `out`.
  /// Returns whether it came to a verdict. Throws fsr::InputError.
  bool run(std::ostream& out);

 private:
  void startRecording(const ros::NodeHandle& private_handle);
  void countCycles();
  bool enough() const;
  void judge(std::ostream& out);

  ros::NodeHandle handle_;
  fsr::report::CheckOutputs outputs_;
  std::vector<std::string> bags_;
  std::optional<double> ambient_;  // [Pa]
  fsr::check::CheckOptions asked_;
  std::size_t wanted_ = 0;  // cycles
  fsr::calibration::Calibration parent_;
  std::unique_ptr<Recorder> recorder_;  // null = bags are given
  ros::Subscriber chamber_;
  ros::WallTimer timer_;
  std::vector<double> pressure_;  // of the chamber since the start [Pa]
  std::size_t cycles_ = 0;        // that have passed
  bool running_ = false;          // the last of them may not have ended
  ros::WallTime changed_;         // when pressure or cycles changed last
  double still_ = 0;              // pressure then [Pa]
};

}  // namespace fsr_ros
