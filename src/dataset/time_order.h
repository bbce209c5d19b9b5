#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

/// Indices of the recordings in the order of their first stamps. Recordings that begin at the same time keep
/// their order.
std::vector<std::size_t> inOrderOfTime(const std::vector<Recording>& recordings);

}  // namespace fsr::dataset
