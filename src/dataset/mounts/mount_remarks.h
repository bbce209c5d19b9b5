#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// A sentence about a recording.
struct MountRemark {
  std::size_t recording = 0;  ///< index
  std::string sentence;
};

/// Mounts are told apart by surface and number alone. One remark for each surface and number under which two
/// recordings were made with a night between them: the matrix may have been taken off, and the number kept.
std::vector<MountRemark> remarksOnMounts(const std::vector<Recording>& recordings);

}  // namespace fsr::dataset
