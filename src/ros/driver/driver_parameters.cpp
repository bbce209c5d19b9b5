#include "ros/driver/driver.h"

#include <limits>
#include <utility>

#include "fsr_pressure_map/protocol/decoder.h"
#include "ros/bags/resource_path.h"

namespace fsr_ros {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TransducerLine readLine(const Parameters& parameters) {
  TransducerLine line;
  line.offset = parameters.number("transducer_offset", line.offset, {-1e8, 1e8, "Pa"});
  line.slope = parameters.number("transducer_slope", line.slope, {-1e6, 1e6, "Pa/count"});
  line.absolute = parameters.flag("transducer_absolute", line.absolute);
  line.deviation = parameters.number("transducer_deviation", line.deviation, {0, 1e7, "Pa"});
  if (line.slope == 0) throw parameters.error("transducer_slope", "must not be 0");
  return line;
}

fsr::matrix::MatrixSize readSize(const Parameters& parameters) {
  const fsr::settings::Range side = {0, fsr::matrix::kMaxMatrixSide, ""};
  return {static_cast<std::uint16_t>(parameters.integer("rows", 0, side)),
          static_cast<std::uint16_t>(parameters.integer("columns", 0, side))};
}

void readLink(const Parameters& parameters, DriverSettings& settings) {
  settings.serial_port = resolveResource(parameters.text("serial_port", settings.serial_port));
  settings.serial_baud =
      static_cast<std::uint32_t>(parameters.integer("serial_baud", settings.serial_baud, {0, 12e6, "baud"}));
  settings.protocol = fsr::protocol::protocolNamed(parameters.text("protocol", settings.protocol)).name;
  settings.read_timeout = parameters.number("read_timeout", settings.read_timeout, {0.01, 3600, "s"});
  const double delay = parameters.number("reconnect_delay", 1.0, {0.01, 3600, "s"});
  settings.reconnect_delay = std::chrono::milliseconds(static_cast<std::int64_t>(delay * 1000));
  settings.capture_file = resolveResource(parameters.text("capture_file", ""));
  settings.replay_file = resolveResource(parameters.text("replay_file", ""));
  if (settings.serial_port.empty()) throw parameters.error("serial_port", "must name the port of the board");
}

// What the bytes of some protocols do not say.
fsr::protocol::DecoderOptions readDecoder(const Parameters& parameters, const DriverSettings& settings) {
  fsr::protocol::DecoderOptions options;
  options.size = settings.expected;
  options.full_scale = static_cast<std::uint16_t>(
      parameters.integer("text_full_scale", options.full_scale, {1, 65535, "counts"}));
  options.tick = parameters.choice("text_time", {"ms", "us"}, "ms") == "ms" ? 1000 : 1;
  options.transducer = parameters.flag("text_transducer", options.transducer);
  const bool tells_size = fsr::protocol::protocolNamed(settings.protocol).tells_size;
  for (const auto& [name, side] : {std::pair("rows", options.size.rows), {"columns", options.size.columns}}) {
    if (tells_size || side > 0) continue;
    throw parameters.error(name, "must be 1 or more with the protocol " + settings.protocol +
                                     ", whose lines do not say the size of the matrix");
  }
  return options;
}

void readIdentity(const Parameters& parameters, DriverSettings& settings) {
  settings.frame_id = parameters.text("frame_id", settings.frame_id);
  settings.sensor_id = parameters.text("sensor_id", "");
  settings.sensor_model = parameters.text("sensor_model", "");
  settings.sealing = parameters.text("sealing", "");
  settings.transducer = parameters.text("transducer", "");
  settings.reference_voltage = parameters.number("reference_voltage", 0, {0, 1000, "V"});
  settings.feedback_resistance = parameters.number("feedback_resistance", 0, {0, 1e12, "ohm"});
  settings.pitch_x = parameters.number("pitch_x", settings.pitch_x, {1e-4, 1, "m"});
  settings.pitch_y = parameters.number("pitch_y", settings.pitch_y, {1e-4, 1, "m"});
}

}  // namespace

DriverSettings readDriverSettings(const Parameters& parameters) {
  DriverSettings settings;
  readLink(parameters, settings);
  readIdentity(parameters, settings);
  settings.expected = readSize(parameters);
  settings.decoder = readDecoder(parameters, settings);
  settings.transducer_line = readLine(parameters);
  settings.time_offset = parameters.number("time_offset", 0, {-3600, 3600, "s"});
  settings.ambient_pressure =
      parameters.number("ambient_pressure", settings.ambient_pressure, {0, 1e7, "Pa"});
  settings.expected_frequency = parameters.number("expected_frequency", 0, {0, 1e5, "1/s"});
  settings.frequency_tolerance = parameters.number("frequency_tolerance", 0.1, {0, kInfinity, ""});
  parameters.warnOfUnknown("driver");
  return settings;
}

}  // namespace fsr_ros
