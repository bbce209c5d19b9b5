// A surface file gives finite curvatures for every taxel, or is refused with one sentence.
#include <cmath>

#include "fsr_pressure_map/matrix/surface_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  try {
    const fsr::Surface surface = fsr::readSurfaceFile(file.path(), {2, 3});
    fuzz::require(surface.curvature.size() == 1 || surface.curvature.size() == 6);
    for (const fsr::Curvature& curvature : surface.curvature) {
      fuzz::require(std::isfinite(curvature.x) && std::isfinite(curvature.y) && std::isfinite(curvature.xy));
    }
  } catch (const fsr::InputError&) {
  }
  return 0;
}
