#pragma once

#include <ostream>

namespace fsr_ros {

/// `calibration_history DIR` reads every bag and calibration file in a folder and its subfolders and shows
/// the life of each sheet by date. Returns 0; 1 if a file could not be used, which is then named; 3 if only
/// the figures could not be drawn. Throws fsr::InputError if there is nothing to show.
int calibrationHistoryTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
