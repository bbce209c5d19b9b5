#pragma once

#include <cerrno>
#include <mutex>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "hdf5/handle.h"
#include "settings/replace_file.h"

// Only sources include this header: it needs HDF5's own.

namespace fsr::exports {

/// Runs `act` alone, because HDF5 is not thread-safe. If HDF5 cannot write, throws an InputError with the
/// reason in errno, since HDF5 gives none.
template <typename Act>
void attempt(const std::string& path, Act act) {
  const std::lock_guard<std::mutex> lock(hdf5::hdf5Mutex());
  errno = 0;
  try {
    act();
  } catch (const settings::InputError&) {
    throw settings::cannotWrite(path, errno != 0 ? errno : EIO);
  }
}

}  // namespace fsr::exports
