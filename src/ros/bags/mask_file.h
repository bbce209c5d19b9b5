#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fsr_ros {

/// Stores the mask of ~set_mask [one value for each taxel, row-major, 1 = masked], so that it survives a
/// restart of the node. An empty path stands for no file. Throws fsr::InputError, also if the file that is
/// there is no mask.
void saveMask(const std::vector<std::uint8_t>& mask, const std::string& path);

/// Reads it again; empty if there is no file. Throws fsr::InputError.
std::vector<std::uint8_t> loadMask(const std::string& path);

}  // namespace fsr_ros
