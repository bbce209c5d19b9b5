// A bag is read or refused. rosbag does not check its input, so it must receive only valid records.
#include <rosconsole/macros_generated.h>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  try {
    fsr_ros::readBag(file.path());
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
