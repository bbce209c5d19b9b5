#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"

namespace fsr::map {

/// Gives each of `taxels` the mean of its up to eight good neighbours, weighted by 1 / distance^2, and
/// flags it kFilled. Its deviation joins the neighbours' own and their scatter about the mean. A
/// neighbour that is dead, stuck, masked or filled is not good; without a good one nothing changes.
/// Allocates nothing.
void fillFromNeighbours(PressureMap& map, const std::vector<std::size_t>& taxels) noexcept;

}  // namespace fsr::map
