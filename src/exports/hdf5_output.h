#pragma once

#include <hdf5.h>

#include <cerrno>
#include <mutex>
#include <optional>
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

/// Creates a file with one group. To be called within attempt(), as closeFile().
inline void createFile(const std::string& path, const std::string& group, std::optional<hdf5::Handle>& file) {
  hdf5::openLibrary();
  file.emplace(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, "file");
  hdf5::Handle(H5Gcreate2(*file, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
               group.c_str());
}

/// Writes what HDF5 still holds, and closes the file.
inline void closeFile(std::optional<hdf5::Handle>& file) {
  hdf5::require(H5Fflush(*file, H5F_SCOPE_GLOBAL), "file");
  file.reset();
}

}  // namespace fsr::exports
