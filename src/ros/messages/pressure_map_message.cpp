#include "fsr_pressure_map/ros/pressure_map_message.h"

#include <algorithm>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

namespace {

using Message = fsr_pressure_map::PressureMap;
namespace flag = fsr::map::taxel_flag;

// States and flags are copied as numbers, so those of the core must equal those of the message.
constexpr bool same(fsr::map::MapState state, std::uint8_t number) {
  return static_cast<std::uint8_t>(state) == number;
}
static_assert(same(fsr::map::MapState::kOk, Message::STATE_OK));
static_assert(same(fsr::map::MapState::kUncalibrated, Message::STATE_UNCALIBRATED));
static_assert(same(fsr::map::MapState::kCurvatureUnknown, Message::STATE_CURVATURE_UNKNOWN));
static_assert(same(fsr::map::MapState::kCurvatureStale, Message::STATE_CURVATURE_STALE));
static_assert(same(fsr::map::MapState::kSizeMismatch, Message::STATE_SIZE_MISMATCH));
static_assert(same(fsr::map::MapState::kWrongSensor, Message::STATE_WRONG_SENSOR));
static_assert(flag::kSaturated == Message::FLAG_SATURATED && flag::kDead == Message::FLAG_DEAD);
static_assert(flag::kStuck == Message::FLAG_STUCK && flag::kFilled == Message::FLAG_FILLED);
static_assert(flag::kReadingExtrapolated == Message::FLAG_READING_EXTRAPOLATED);
static_assert(flag::kCurvatureExtrapolated == Message::FLAG_CURVATURE_EXTRAPOLATED);
static_assert(flag::kBetweenClasses == Message::FLAG_BETWEEN_CLASSES);
static_assert(flag::kMasked == Message::FLAG_MASKED && flag::kLineFault == Message::FLAG_LINE_FAULT);
static_assert(flag::kTared == Message::FLAG_TARED && flag::kBelowRange == Message::FLAG_BELOW_RANGE);
static_assert(flag::kTemperatureExtrapolated == Message::FLAG_TEMPERATURE_EXTRAPOLATED);
static_assert(flag::kHistoryShort == Message::FLAG_HISTORY_SHORT);

void requireTaxels(const char* field, std::size_t values, const Message& message) {
  const std::size_t taxels = std::size_t{message.rows} * message.columns;
  if (values != taxels) {
    throw fsr::settings::InputError(std::string("pressure map message: ") + field + " has " +
                                    std::to_string(values) + " values, but must have rows x columns, " +
                                    std::to_string(taxels));
  }
}

}  // namespace

fsr::matrix::ScanView toScanView(const fsr_pressure_map::MatrixFrame& message) {
  return {{message.rows, message.columns}, message.full_scale, message.counts.data(), message.counts.size()};
}

void fillMessage(const fsr::map::PressureMap& map, Message& message) {
  message.state = static_cast<std::uint8_t>(map.state);
  message.rows = map.layout.size.rows;
  message.columns = map.layout.size.columns;
  message.pitch_x = static_cast<float>(map.layout.pitch_x);
  message.pitch_y = static_cast<float>(map.layout.pitch_y);
  message.pressure = map.pressure;
  message.deviation = map.deviation;
  message.flags = map.flags;
}

fsr::map::PressureMap toPressureMap(const Message& message) {
  if (std::max(message.rows, message.columns) > fsr::matrix::kMaxMatrixSide) {
    throw fsr::settings::InputError("pressure map message: has " + std::to_string(message.rows) + " x " +
                                    std::to_string(message.columns) + " taxels, but must have " +
                                    std::to_string(fsr::matrix::kMaxMatrixSide) +
                                    " rows and columns at most");
  }
  requireTaxels("pressure", message.pressure.size(), message);
  requireTaxels("deviation", message.deviation.size(), message);
  requireTaxels("flags", message.flags.size(), message);
  if (message.state > Message::STATE_WRONG_SENSOR) {
    throw fsr::settings::InputError("pressure map message: state is " + std::to_string(message.state) +
                                    ", but must be one of PressureMap.msg, 0 to 5");
  }
  fsr::map::PressureMap map;
  map.layout = {{message.rows, message.columns}, message.pitch_x, message.pitch_y};
  map.state = static_cast<fsr::map::MapState>(message.state);
  map.pressure = message.pressure;
  map.deviation = message.deviation;
  map.flags = message.flags;
  return map;
}

}  // namespace fsr_ros
