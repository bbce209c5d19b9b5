#include "ros/messages/message_reader.h"

#include <cstddef>
#include <set>
#include <utility>

namespace fsr_ros {

bool hadDefinition(const std::string& type, const std::string& md5sum) {
  static const std::set<std::pair<std::string, std::string>> definitions = {
      // Without FLAG_HISTORY_SHORT.
      {"fsr_pressure_map/PressureMap", "50c65025fc4b01118cf4b0ef3469834e"},
  };
  return definitions.count({type, md5sum}) > 0;
}

std::size_t fieldsAdded(const std::string& type, const std::string& md5sum) {
  // Without parent and corrected.
  const bool info =
      type == "fsr_pressure_map/CalibrationInfo" && md5sum == "883c2521a8e1943b05728716309ddb06";
  return info ? 2 : 0;
}

}  // namespace fsr_ros
