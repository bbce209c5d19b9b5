#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"

namespace fsr::map {

/// Sets each of `taxels` to the mean of its up to eight valid neighbours, weighted by 1 / distance^2, and
/// flags it kFilled. Its deviation combines those of the neighbours and their scatter about the mean. A
/// neighbour that is dead, stuck, masked or filled is not valid. Without a valid neighbour nothing changes.
/// Allocates nothing.
void fillFromNeighbours(PressureMap& map, const std::vector<std::size_t>& taxels) noexcept;

}  // namespace fsr::map
