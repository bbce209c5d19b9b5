// A capture is replayed up to the first damage. A damaged length allocates no more memory than a chunk may
// have.
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"
#include "protocol/capture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  try {
    fsr::protocol::CaptureReader reader(file.path());
    std::vector<std::uint8_t> buffer(4096);
    std::size_t total = 0;
    while (!reader.ended())
      total += reader.read(buffer.data(), buffer.size(), std::chrono::milliseconds(0)).size;
    fuzz::require(total <= size);
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
