#pragma once

#include <string>
#include <vector>

#include "exports/map_pictures.h"
#include "settings/command_line.h"

namespace fsr_ros {

/// Adds the options for pictures to the command line of `export`. They have the names of the view node's
/// parameters.
void declarePictureOptions(fsr::settings::CommandLine& line);
std::vector<std::string> pictureOptionNames();

/// Throws fsr::InputError that names the option and what would be right.
fsr::exports::PictureOptions pictureOptions(const fsr::settings::CommandLine& line);

}  // namespace fsr_ros
