#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <string>

#include "calibration/stages/session/tare.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "ros/live/parameters.h"

namespace fsr_ros {

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

}  // namespace fsr_ros
