#pragma once

#include "fsr_pressure_map/map/pressure_map.h"

namespace fsr::map {

/// Makes `peaks` the map of the highest pressure of each taxel, with its deviation and flags: those of `map`
/// where it is higher, where `peaks` has no reading, or where `peaks` is of another size. The state is that
/// of `map`.
void holdPeaks(const PressureMap& map, PressureMap& peaks);

}  // namespace fsr::map
