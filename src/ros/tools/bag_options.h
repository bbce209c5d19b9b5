#pragma once

#include "fsr_pressure_map/ros/bag_reader.h"
#include "settings/command_line.h"

namespace fsr_ros {

/// How a tool reads bags: by its options --namespace and --ambient, the counts of long bags into a file.
/// Throws fsr::settings::InputError.
BagReadOptions bagReadOptions(const fsr::settings::CommandLine& line);

}  // namespace fsr_ros
