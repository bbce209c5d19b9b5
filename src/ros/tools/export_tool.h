#pragma once

#include <ostream>
#include <vector>

#include "exports/scan_formats.h"

namespace fsr_ros {

/// `export BAG... --to FORMAT --output PATH` writes a recording in a format that other programs read without
/// ROS: one of `scan_formats`, or `hdf5`, an archive of every topic. `export ARCHIVE.h5 --to bag --output
/// BAG` restores the bag from such an archive. Writes to `out` what was written and where. Returns 0. Throws
/// InputError; then there is no new file.
int exportTool(int argc, const char* const* argv, std::ostream& out,
               const std::vector<fsr::exports::ScanFormat>& scan_formats = fsr::exports::scanFormats());

}  // namespace fsr_ros
