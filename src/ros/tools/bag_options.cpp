#include "ros/tools/bag_options.h"

namespace fsr_ros {

namespace {

constexpr std::size_t kCountsInMemory = 8u << 20;  // of a bag [bytes]

}  // namespace

BagReadOptions bagReadOptions(const fsr::settings::CommandLine& line) {
  BagReadOptions how;
  how.counts_in_memory = kCountsInMemory;
  how.topics = line.text("namespace", "");
  if (line.has("ambient")) how.ambient_pressure = line.number("ambient", 0, {0, 120e3, "Pa"});
  return how;
}

}  // namespace fsr_ros
