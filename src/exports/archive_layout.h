#pragma once

// What writer and reader of an archive share.

#include <cstdint>
#include <string>

namespace fsr::archive {

constexpr char kFormat[] = "fsr_pressure_map archive";
constexpr std::uint64_t kSchema = 1;
constexpr char kColumns[] = "columns";
constexpr char kBytes[] = "bytes";

/// The line that the user block begins with.
inline std::string firstLine(const std::string& sha256) {
  return std::string(kFormat) + " schema=" + std::to_string(kSchema) + " sha256=" + sha256 + "\n";
}

}  // namespace fsr::archive
