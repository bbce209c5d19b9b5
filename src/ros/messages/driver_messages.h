#pragma once

#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>

#include <cstdint>
#include <string>

#include "fsr_pressure_map/protocol/decoder.h"
#include "protocol/packet_stamper.h"
#include "ros/messages/driver_settings.h"

namespace fsr_ros {

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

/// The stamp of the header is left 0.
fsr_pressure_map::MatrixInfo matrixInfo(const Board& board, const DriverSettings& settings);

}  // namespace fsr_ros
