#include "ros/messages/earlier_definitions.h"

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

}  // namespace fsr_ros
