// A simulation file is read, or refused with one sentence.
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  try {
    fsr::simulation::readSimulationFile(file.path());
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
