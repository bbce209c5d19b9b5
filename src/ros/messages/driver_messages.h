#pragma once

#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>

#include <cstdint>
#include <string>

#include "fsr_pressure_map/protocol/packet.h"
#include "protocol/packet_stamper.h"
#include "ros/messages/driver_settings.h"

namespace fsr_ros {

/// What is known of the board that is connected.
struct Board {
  std::string serial;  ///< empty until it said who it is
  std::string firmware;
  std::string model;
  fsr::matrix::MatrixSize size;  ///< 0 x 0 until a scan or an identity came
  std::uint16_t full_scale = 0;
  double scan_period = 0;  ///< [s]; 0 = unknown
};

/// Texts of the board as printable ASCII, anything else as '?': ROS strings are to be UTF-8.
Board toBoard(const fsr::protocol::IdentityPacket& identity);

/// Header of what was true at `time` [host, ns], `offset` [s] later. Stamp 0 where that lies before time
/// began.
std_msgs::Header headerAt(std::int64_t time, const DriverSettings& settings);

fsr_pressure_map::MatrixFramePtr scanMessage(const fsr::protocol::PacketHeader& header,
                                             const fsr::protocol::ScanPacket& scan,
                                             const fsr::protocol::PacketTime& time,
                                             const DriverSettings& settings);

/// Absolute pressure from the transducer's counts.
sensor_msgs::FluidPressurePtr pressureMessage(std::int32_t counts, const fsr::protocol::PacketTime& time,
                                              const DriverSettings& settings);

sensor_msgs::TemperaturePtr temperatureMessage(std::int32_t millidegrees,
                                               const fsr::protocol::PacketTime& time,
                                               const DriverSettings& settings);

/// Header's stamp left 0.
fsr_pressure_map::MatrixInfo matrixInfo(const Board& board, const DriverSettings& settings);

}  // namespace fsr_ros
