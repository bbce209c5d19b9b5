#include <map>

#include "exports/message_table.h"

namespace fsr::exports {

namespace {

// Units of fields whose comment has no unit in brackets, by "type field".
const std::map<std::string, std::string>& knownUnits() {
  static const std::map<std::string, std::string> kUnits = {
      {"sensor_msgs/FluidPressure fluid_pressure", "Pa"},
      {"sensor_msgs/FluidPressure variance", "Pa^2"},
      {"sensor_msgs/Temperature temperature", "degree Celsius"},
      {"sensor_msgs/Temperature variance", "degree Celsius^2"},
      {"fsr_pressure_map/MatrixFrame counts", "counts"},
      {"fsr_pressure_map/MatrixFrame full_scale", "counts"},
      {"fsr_pressure_map/MatrixInfo full_scale", "counts"},
      {"fsr_pressure_map/MatrixInfo pitch_y", "m"},
      {"fsr_pressure_map/PressureMap pitch_y", "m"},
      {"fsr_pressure_map/SurfaceCurvature x", "1/m"},
      {"fsr_pressure_map/SurfaceCurvature y", "1/m"},
      {"fsr_pressure_map/SurfaceCurvature xy", "1/m"},
      {"fsr_pressure_map/CalibrationInfo pressure_high", "Pa"},
      {"fsr_pressure_map/CalibrationInfo temperature_high", "degree Celsius"},
      {"fsr_pressure_map/CalibrationInfo curvature_high", "1/m"},
      {"fsr_pressure_map/CalibrationInfo pressure_rate_high", "Pa/s"},
  };
  return kUnits;
}

std::string bracketed(const std::string& comment) {
  const std::size_t open = comment.find('[');
  const std::size_t close = comment.find(']', open);
  return open == std::string::npos || close == std::string::npos ? ""
                                                                 : comment.substr(open + 1, close - open - 1);
}

}  // namespace

std::pair<std::string, std::string> unitAndMeaning(const std::string& type, const MessageField& field) {
  if (field.scalar == Scalar::kTime && !field.nested) {
    return {"ns", field.comment.empty() ? "since 1970, UTC" : field.comment};
  }
  if (field.scalar == Scalar::kDuration && !field.nested) return {"ns", field.comment};
  const auto known = knownUnits().find(type + ' ' + field.name);
  // Brackets in the comment of a text field are a pattern such as [A-Z]{1,3}[0-9]{2,4}, not a unit.
  const bool text = !field.nested && field.scalar == Scalar::kString;
  if (known != knownUnits().end()) return {known->second, field.comment};
  return {text ? "" : bracketed(field.comment), field.comment};
}

}  // namespace fsr::exports
