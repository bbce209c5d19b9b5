#pragma once

#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/PressureMap.h>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/scan.h"

namespace fsr_ros {

/// The scan in a message. The counts are not copied: the view is valid as long as the message.
fsr::matrix::ScanView toScanView(const fsr_pressure_map::MatrixFrame& message);

/// Writes a map to a message. The fields header, calibration and scheme are not part of a map and stay as
/// they are.
void fillMessage(const fsr::map::PressureMap& map, fsr_pressure_map::PressureMap& message);

/// The map in a message. Throws fsr::settings::InputError if an array does not have rows x columns values or
/// if the state is unknown.
fsr::map::PressureMap toPressureMap(const fsr_pressure_map::PressureMap& message);

}  // namespace fsr_ros
