#include "ros/messages/driver_messages.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <sstream>

namespace fsr_ros {
namespace {

std::string printable(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c < ' ' || c > '~') c = '?';
  }
  return result;
}

}  // namespace

Board toBoard(const fsr::protocol::IdentityPacket& identity) {
  Board board;
  board.serial = printable(identity.serial);
  board.firmware = printable(identity.firmware);
  board.model = printable(identity.model);
  board.size = identity.size;
  board.full_scale = identity.full_scale;
  board.scan_period = identity.scan_period * 1e-6;
  return board;
}

std_msgs::Header headerAt(std::int64_t time, const DriverSettings& settings) {
  std_msgs::Header header;
  const std::int64_t stamp = time + std::llround(settings.time_offset * 1e9);
  if (stamp > 0) header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
  header.frame_id = settings.frame_id;
  return header;
}

fsr_pressure_map::MatrixFramePtr scanMessage(const fsr::protocol::PacketHeader& header,
                                             const fsr::protocol::ScanPacket& scan,
                                             const fsr::protocol::PacketTime& time,
                                             const DriverSettings& settings) {
  auto message = boost::make_shared<fsr_pressure_map::MatrixFrame>();
  message->header = headerAt(time.stamp, settings);
  message->sequence = header.sequence;
  message->device_time = time.device_time;
  message->scan_duration = static_cast<float>(scan.duration * 1e-6);
  message->rows = scan.size.rows;
  message->columns = scan.size.columns;
  message->full_scale = scan.full_scale;
  message->counts.assign(scan.counts, scan.counts + scan.size.taxels());
  return message;
}

sensor_msgs::FluidPressurePtr pressureMessage(std::int32_t counts, const fsr::protocol::PacketTime& time,
                                              const DriverSettings& settings) {
  const TransducerLine& line = settings.transducer_line;
  auto message = boost::make_shared<sensor_msgs::FluidPressure>();
  message->header = headerAt(time.stamp, settings);
  message->fluid_pressure =
      line.offset + line.slope * counts + (line.absolute ? 0 : settings.ambient_pressure);
  message->variance = line.deviation * line.deviation;
  return message;
}

sensor_msgs::TemperaturePtr temperatureMessage(std::int32_t millidegrees,
                                               const fsr::protocol::PacketTime& time,
                                               const DriverSettings& settings) {
  auto message = boost::make_shared<sensor_msgs::Temperature>();
  message->header = headerAt(time.stamp, settings);
  message->temperature = millidegrees * 1e-3;
  return message;
}

fsr_pressure_map::Event triggerMessage(const fsr::protocol::TriggerPacket& trigger,
                                       const fsr::protocol::PacketTime& time,
                                       const DriverSettings& settings) {
  fsr_pressure_map::Event event;
  event.header = headerAt(time.stamp, settings);
  event.kind = "sync";
  std::ostringstream label;
  label << "trigger " << (trigger.high ? "rising" : "falling") << " +- " << std::fixed << std::setprecision(3)
        << trigger.deviation * 1e-3 << " ms";
  event.label = label.str();
  return event;
}

fsr_pressure_map::MatrixInfo matrixInfo(const Board& board, const DriverSettings& settings) {
  fsr_pressure_map::MatrixInfo info;
  info.header.frame_id = settings.frame_id;
  info.sensor_id = settings.sensor_id.empty() ? board.serial : settings.sensor_id;
  info.serial = board.serial;
  info.firmware = board.firmware;
  info.sensor_model = settings.sensor_model;
  info.sealing = settings.sealing;
  info.rows = board.size.rows;
  info.columns = board.size.columns;
  info.full_scale = board.full_scale;
  info.pitch_x = static_cast<float>(settings.pitch_x);
  info.pitch_y = static_cast<float>(settings.pitch_y);
  info.reference_voltage = static_cast<float>(settings.reference_voltage);
  info.feedback_resistance = static_cast<float>(settings.feedback_resistance);
  info.ambient_pressure = settings.ambient_pressure;
  info.transducer = settings.transducer;
  return info;
}

fsr::matrix::Layout layoutOf(fsr::matrix::MatrixSize size, const fsr_pressure_map::MatrixInfo& board) {
  fsr::matrix::Layout layout{size};
  if (board.pitch_x > 0) layout.pitch_x = board.pitch_x;
  if (board.pitch_y > 0) layout.pitch_y = board.pitch_y;
  return layout;
}

std::string sameBoardSentence(const std::map<std::string, std::string>& serials) {
  for (auto first = serials.begin(); first != serials.end(); ++first) {
    const auto second = std::find_if(std::next(first), serials.end(),
                                     [&](const auto& other) { return other.second == first->second; });
    if (first->second.empty() || second == serials.end()) continue;
    return first->first + " and " + second->first + " have the same serial number, " + first->second +
           ": give each sheet the serial_port of its own board, and each board a serial number of its own";
  }
  return "";
}

}  // namespace fsr_ros
