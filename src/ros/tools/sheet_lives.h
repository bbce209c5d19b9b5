#pragma once

#include <ostream>

#include "settings/command_line.h"

namespace fsr_ros {

/// The life of each sheet in the folder of a command line of check_calibration. Returns 0, 1 if a file could
/// not be used, 3 if only the figures are missing. Throws fsr::InputError.
int showLives(const fsr::settings::CommandLine& line, std::ostream& out);

}  // namespace fsr_ros
