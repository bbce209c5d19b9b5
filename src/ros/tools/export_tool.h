#pragma once

#include <ostream>
#include <vector>

#include "exports/scan_formats.h"

namespace fsr_ros {

/// `export BAG... --to FORMAT --output PATH` writes a recording in a format that other programs read without
/// ROS: one of `formats`. Writes to `out` what was written and where. Returns 0. Throws InputError; then
/// there is no new file.
int exportTool(int argc, const char* const* argv, std::ostream& out,
               const std::vector<fsr::exports::ScanFormat>& formats = fsr::exports::scanFormats());

}  // namespace fsr_ros
