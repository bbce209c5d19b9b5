#pragma once

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/protocol/decoder.h"
#include "protocol/device_clock.h"

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

/// Description of the connected board.
struct Board {
  std::string serial;  ///< empty until the board has sent its identity
  std::string firmware;
  std::string model;
  fsr::matrix::MatrixSize size;  ///< 0 x 0 until a scan or the identity has come
  std::uint16_t full_scale = 0;
  double scan_period = 0;  ///< [s]; 0 = unknown
};

/// Converts an identity packet. Characters other than printable ASCII become '?', because ROS strings must be
/// UTF-8.
Board toBoard(const fsr::protocol::IdentityPacket& identity);

/// Header with the stamp `time` (host clock [ns]) plus the time_offset of the settings. The stamp is 0 if the
/// sum is negative.
std_msgs::Header headerAt(std::int64_t time, const DriverSettings& settings);

fsr_pressure_map::MatrixFramePtr scanMessage(const fsr::protocol::PacketHeader& header,
                                             const fsr::protocol::ScanPacket& scan,
                                             const fsr::protocol::PacketTime& time,
                                             const DriverSettings& settings);

/// Absolute pressure [Pa] from the counts of the transducer.
sensor_msgs::FluidPressurePtr pressureMessage(std::int32_t counts, const fsr::protocol::PacketTime& time,
                                              const DriverSettings& settings);

sensor_msgs::TemperaturePtr temperatureMessage(std::int32_t millidegrees,
                                               const fsr::protocol::PacketTime& time,
                                               const DriverSettings& settings);

/// Kind `sync`, label "trigger rising +- 0.002 ms": the edge lies at most so far from the stamp, on the clock
/// of the scans' stamps.
fsr_pressure_map::Event triggerMessage(const fsr::protocol::TriggerPacket& trigger,
                                       const fsr::protocol::PacketTime& time, const DriverSettings& settings);

/// The stamp of the header is left 0.
fsr_pressure_map::MatrixInfo matrixInfo(const Board& board, const DriverSettings& settings);

/// Layout with the pitch in matrix_info, or the default pitch where it states none.
fsr::matrix::Layout layoutOf(fsr::matrix::MatrixSize size, const fsr_pressure_map::MatrixInfo& board);

/// A sentence that names two sheets whose boards have one serial number, and says what would be right; empty
/// = there are none. `serials`: serial number by the namespace of each sheet; empty = unknown.
std::string sameBoardSentence(const std::map<std::string, std::string>& serials);

}  // namespace fsr_ros
