#pragma once

#include <fsr_pressure_map/PressureStatistics.h>

#include "fsr_pressure_map/map/map_statistics.h"

namespace fsr_ros {

/// `layout` gives the peak's row and column. Without contact the centre is NaN.
fsr_pressure_map::PressureStatistics toMessage(const fsr::map::RegionStatistics& statistics,
                                               const fsr::matrix::Layout& layout);

/// All but the peak's taxel and the centre, which have no meaning beyond their own sheet.
fsr::map::RegionStatistics toStatistics(const fsr_pressure_map::PressureStatistics& message);

}  // namespace fsr_ros
