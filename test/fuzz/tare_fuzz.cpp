// A tare file gives a finite offset for every taxel, or is refused with one sentence.
#include <cmath>

#include "fsr_pressure_map/calibration/tare.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  try {
    const fsr::Tare tare = fsr::loadTare(file.path());
    fuzz::require(tare.offset.size() == tare.size.taxels());
    for (const float offset : tare.offset) fuzz::require(std::isfinite(offset));
  } catch (const fsr::InputError&) {
  }
  return 0;
}
