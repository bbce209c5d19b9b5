#pragma once

#include <ostream>

namespace fsr_ros {

/// `export BAG... --to csv|tekscan|hdf5|png|movie --output PATH` and `export ARCHIVE.h5 --to bag --output
/// BAG`: writes a recording in a format that needs no ROS. Prints to `out` what was written and where.
/// Returns 0. Throws fsr::InputError; in that case no new file is left.
int exportTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
