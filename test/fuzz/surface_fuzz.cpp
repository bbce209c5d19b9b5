// A surface file gives finite curvatures for every taxel, or is refused with one sentence.
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"
#include "matrix/surface_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  try {
    const fsr::matrix::Surface surface = fsr::matrix::readSurfaceFile(file.path(), {2, 3});
    fuzz::require(surface.curvature.size() == 1 || surface.curvature.size() == 6);
    for (const fsr::matrix::Curvature& curvature : surface.curvature) {
      fuzz::require(std::isfinite(curvature.x) && std::isfinite(curvature.y) && std::isfinite(curvature.xy));
    }
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
