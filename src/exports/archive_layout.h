#pragma once

// Definitions that writer and reader of an archive share.

#include <cerrno>
#include <cstdint>
#include <string>

#include "settings/replace_file.h"

namespace fsr::exports::archive {

constexpr char kFormat[] = "fsr_pressure_map archive";
constexpr std::uint64_t kSchema = 1;
constexpr char kColumns[] = "columns";
constexpr char kBytes[] = "bytes";

/// First line of the user block.
inline std::string firstLine(const std::string& sha256) {
  return std::string(kFormat) + " schema=" + std::to_string(kSchema) + " sha256=" + sha256 + "\n";
}

// Runs `act`. If HDF5 cannot write, throws an InputError with the reason in errno, since HDF5 gives none.
template <typename Act>
void attempt(const std::string& path, Act act) {
  errno = 0;
  try {
    act();
  } catch (const settings::InputError&) {
    throw settings::cannotWrite(path, errno != 0 ? errno : EIO);
  }
}

}  // namespace fsr::exports::archive
