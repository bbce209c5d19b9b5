#pragma once

#include <string>
#include <vector>

#include "exports/map_pictures.h"
#include "settings/command_line.h"

namespace fsr_ros {

/// How `export` draws maps: the options of its command line, named as the view's parameters are.
void declarePictureOptions(fsr::settings::CommandLine& line);
std::vector<std::string> pictureOptionNames();

/// Throws fsr::InputError that names the option and what would be right.
fsr::exports::PictureOptions pictureOptions(const fsr::settings::CommandLine& line);

}  // namespace fsr_ros
