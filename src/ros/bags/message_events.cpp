#include "ros/bags/message_events.h"

#include <algorithm>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/messages/message_reader.h"
#include "ros/messages/surface_message.h"

namespace fsr_ros {

namespace {

void require(bool good, const std::string& complaint) {
  if (!good) throw fsr::settings::InputError("matrix_info: " + complaint);
}

}  // namespace

fsr::dataset::MatrixDescription toDescription(const fsr_pressure_map::MatrixInfo& message) {
  const std::size_t taxels = std::size_t{message.rows} * message.columns;
  require(message.pitch_x > 0 && message.pitch_y > 0,
          "pitch_x and pitch_y are " + std::to_string(message.pitch_x) + " and " +
              std::to_string(message.pitch_y) + " m, but must be positive");
  require(std::max(message.rows, message.columns) <= fsr::matrix::kMaxMatrixSide,
          "rows and columns are " + std::to_string(message.rows) + " and " + std::to_string(message.columns) +
              ", but must be " + std::to_string(fsr::matrix::kMaxMatrixSide) + " at most");
  require(message.mask.empty() || message.mask.size() == taxels,
          "mask has " + std::to_string(message.mask.size()) + " values, but must have none or " +
              std::to_string(taxels));
  fsr::dataset::MatrixDescription description;
  description.sensor = {message.sensor_id,    message.serial,  message.firmware,
                        message.sensor_model, message.sealing, message.transducer};
  description.layout.size = {message.rows, message.columns};
  description.layout.pitch_x = message.pitch_x;
  description.layout.pitch_y = message.pitch_y;
  description.full_scale = message.full_scale;
  description.ambient_pressure = message.ambient_pressure;
  description.mask = message.mask;
  return description;
}

void addEvent(const fsr_pressure_map::MatrixFrame& message, fsr::dataset::RecordingBuilder& builder) {
  builder.addScan(
      stampOf(message.header), message.sequence,
      {{message.rows, message.columns}, message.full_scale, message.counts.data(), message.counts.size()});
}

void addEvent(const sensor_msgs::FluidPressure& message, fsr::dataset::RecordingBuilder& builder) {
  builder.addChamberPressure(stampOf(message.header), message.fluid_pressure);
}

void addEvent(const fsr_pressure_map::SurfaceCurvature& message, fsr::dataset::RecordingBuilder& builder) {
  builder.addSurface(stampOf(message.header), toSurface(message));
}

void addEvent(const sensor_msgs::Temperature& message, fsr::dataset::RecordingBuilder& builder) {
  builder.addTemperature(stampOf(message.header), message.temperature);
}

void addEvent(const fsr_pressure_map::MatrixInfo& message, fsr::dataset::RecordingBuilder& builder) {
  builder.addDescription(stampOf(message.header), toDescription(message));
}

void addEvent(const fsr_pressure_map::Event& message, fsr::dataset::RecordingBuilder& builder) {
  if (message.kind == "reject")
    builder.addAttemptEnd({stampOf(message.header), fsr::dataset::rejectReasonIn(message.label)});
  if (message.kind == "step") builder.addAttemptEnd({stampOf(message.header), {}});
}

}  // namespace fsr_ros
