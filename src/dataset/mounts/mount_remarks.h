#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

inline constexpr double kCertain = 0.05;  ///< what chance makes less often is certain

/// A sentence about a recording.
struct MountRemark {
  std::size_t recording = 0;  ///< index
  std::string sentence;
  double by_chance = 0;  ///< share of recordings without any mistake that get such a remark; 0 = not by chance

  bool certain() const { return by_chance < kCertain; }
};

/// Mounts are told apart by surface and number alone. One remark for each surface and number under which two
/// recordings were made with a night between them: the matrix may have been taken off, and the number kept.
std::vector<MountRemark> remarksOnMounts(const std::vector<Recording>& recordings);

}  // namespace fsr::dataset
