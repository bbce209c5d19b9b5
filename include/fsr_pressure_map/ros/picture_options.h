#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/exports/map_pictures.h"
#include "fsr_pressure_map/settings/command_line.h"

namespace fsr_ros {

/// How `export` draws maps: the options of its command line, named as the view's parameters are.
void declarePictureOptions(fsr::CommandLine& line);
std::vector<std::string> pictureOptionNames();

/// Throws fsr::InputError that names the option and what would be right.
fsr::PictureOptions pictureOptions(const fsr::CommandLine& line);

}  // namespace fsr_ros
