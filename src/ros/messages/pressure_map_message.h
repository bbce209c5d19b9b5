#pragma once

#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/PressureMap.h>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/scan.h"

namespace fsr_ros {

/// The message's counts, not copied: valid as long as the message.
fsr::matrix::ScanView toScanView(const fsr_pressure_map::MatrixFrame& message);

/// Fills all but header, calibration and scheme, which a map does not know.
void fillMessage(const fsr::map::PressureMap& map, fsr_pressure_map::PressureMap& message);

/// Throws fsr::InputError where an array is not rows x columns, or a state is unknown.
fsr::map::PressureMap toPressureMap(const fsr_pressure_map::PressureMap& message);

}  // namespace fsr_ros
