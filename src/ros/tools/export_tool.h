#pragma once

#include <ostream>

namespace fsr_ros {

/// `export BAG... --to csv|tekscan|hdf5|png|movie --output PATH` and `export ARCHIVE.h5 --to bag --output
/// BAG`: a recording for those who have no ROS. Says to `out` what was written and where. Returns 0; throws
/// fsr::InputError, and then there is no new file.
int exportTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
