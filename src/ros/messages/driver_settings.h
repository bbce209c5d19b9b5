#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/protocol/decoder.h"

namespace fsr_ros {

/// Conversion of the counts of the chamber's transducer to pressure: offset + slope * counts. Defaults: 12
/// bits over -103 to 1034 kPa gauge, as in the emulated rig. The deviation is that of an error evenly
/// distributed within 0.25 % of 1,137 kPa (divided by sqrt 3).
struct TransducerLine {
  double offset = -103e3;        ///< pressure at 0 counts [Pa]
  double slope = 1137e3 / 4096;  ///< pressure per count [Pa]
  bool absolute = false;         ///< true: offset and slope give absolute pressure, not gauge
  double deviation = 1641;       ///< standard deviation of a reading [Pa]; 0 = unknown
};

/// Parameters of the driver and their defaults.
struct DriverSettings {
  std::string serial_port = "/dev/ttyACM0";
  std::uint32_t serial_baud = 115200;  ///< [1/s]; 0 = native USB, which has no baud rate
  std::string protocol =
      "wire";  ///< name of the protocol that the board speaks, see fsr::protocol::protocols()
  fsr::protocol::DecoderOptions decoder{};  ///< for a protocol whose bytes do not say it
  std::string frame_id = "fsr_matrix";
  std::string sensor_id;             ///< empty = the board's serial number
  fsr::matrix::MatrixSize expected;  ///< expected matrix size; 0 = accept what the board reports
  double pitch_x = 0.010;            ///< [m]
  double pitch_y = 0.010;            ///< [m]
  double read_timeout = 1.0;         ///< time without bytes after which diagnostics report an error [s]
  std::chrono::milliseconds reconnect_delay{1000};
  double time_offset = 0;            ///< added to every stamp [s]
  double ambient_pressure = 101325;  ///< added to gauge readings [Pa]
  std::string capture_file;          ///< file for the received bytes, resolved path; empty = none
  std::string replay_file;           ///< capture file to replay, resolved path; empty = read the serial port
  double expected_frequency = 0;     ///< expected scan rate [1/s]; 0 = what the board reports
  double frequency_tolerance = 0.1;  ///< accepted relative deviation of the scan rate (ratio)
  TransducerLine transducer_line;
  std::string sensor_model;
  std::string sealing;
  std::string transducer;          ///< model, serial number, calibration date
  double reference_voltage = 0;    ///< [V]; 0 = unknown
  double feedback_resistance = 0;  ///< [ohm]; 0 = unknown
};

}  // namespace fsr_ros
