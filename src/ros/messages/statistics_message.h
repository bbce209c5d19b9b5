#pragma once

#include <fsr_pressure_map/PressureStatistics.h>

#include "fsr_pressure_map/map/map_statistics.h"

namespace fsr_ros {

/// Converts statistics to a message, without header. `layout` is needed for the row and column of the peak.
/// The centre of pressure is NaN without contact.
fsr_pressure_map::PressureStatistics toMessage(const fsr::map::RegionStatistics& statistics,
                                               const fsr::matrix::Layout& layout);

/// Converts a message back, except for the taxel of the peak and the centre of pressure, which apply to one
/// sheet only.
fsr::map::RegionStatistics toStatistics(const fsr_pressure_map::PressureStatistics& message);

}  // namespace fsr_ros
