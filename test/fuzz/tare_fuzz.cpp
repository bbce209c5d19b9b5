// A tare file gives a finite offset for every taxel, or is refused with one sentence.
#include <cmath>

#include "calibration/stages/session/tare.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  try {
    const fsr::calibration::Tare tare = fsr::calibration::loadTare(file.path());
    fuzz::require(tare.offset.size() == tare.size.taxels());
    for (const float offset : tare.offset) fuzz::require(std::isfinite(offset));
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
