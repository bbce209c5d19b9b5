#include "ros/tools/bag_options.h"

namespace fsr_ros {

BagReadOptions bagReadOptions(const fsr::settings::CommandLine& line) {
  BagReadOptions how;
  how.topics = line.text("namespace", "");
  if (line.has("ambient")) how.ambient_pressure = line.number("ambient", 0, {0, 120e3, "Pa"});
  return how;
}

}  // namespace fsr_ros
