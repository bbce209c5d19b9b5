// A calibration file is refused before HDF5 reads it unless its bytes match the hash in its first line.
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::MemoryFile file(bytes, size);
  try {
    fsr::calibration::loadCalibration(file.path());
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
