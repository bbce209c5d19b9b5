#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr_ros {

/// The straight line from the chamber transducer's counts to pressure. Defaults: 12 bits over -103 to 1034
/// kPa gauge, as the emulated rig's; the deviation is its 0.25 % of 1,137 kPa taken as evenly spread (/ sqrt
/// 3).
struct TransducerLine {
  double offset = -103e3;        ///< pressure at 0 counts [Pa]
  double slope = 1137e3 / 4096;  ///< [Pa] a count
  bool absolute = false;         ///< true: the line gives absolute pressure, not gauge
  double deviation = 1641;       ///< one standard deviation of a reading [Pa]; 0 = unknown
};

/// Every parameter of the driver with its default.
struct DriverSettings {
  std::string serial_port = "/dev/ttyACM0";
  std::uint32_t serial_baud = 115200;  ///< [1/s]; 0 = native USB: no speed to set, bytes take no time
  std::string protocol = "wire";       ///< that the board speaks: a name of fsr::protocol::protocols()
  std::string frame_id = "fsr_matrix";
  std::string sensor_id;             ///< empty = the board's serial number
  fsr::matrix::MatrixSize expected;  ///< 0 = what the board says
  double pitch_x = 0.010;            ///< [m]
  double pitch_y = 0.010;            ///< [m]
  double read_timeout = 1.0;         ///< silence that diagnostics complain about [s]
  std::chrono::milliseconds reconnect_delay{1000};
  double time_offset = 0;            ///< added to every stamp [s]
  double ambient_pressure = 101325;  ///< added to gauge readings [Pa]
  std::string capture_file;          ///< resolved path; empty = none
  std::string replay_file;           ///< resolved path; empty = the serial port
  double expected_frequency = 0;     ///< scans a second [1/s]; 0 = what the board says
  double frequency_tolerance = 0.1;  ///< that diagnostics put up with (ratio)
  TransducerLine transducer_line;
  std::string sensor_model;
  std::string sealing;
  std::string transducer;          ///< model, serial number, calibration date
  double reference_voltage = 0;    ///< [V]; 0 = unknown
  double feedback_resistance = 0;  ///< [ohm]; 0 = unknown
};

}  // namespace fsr_ros
