#pragma once

#include <ostream>

namespace fsr_ros {

/// `train BAG... --output FILE`: trains a calibration. Prints coverage, scores and the full path of the file
/// to `out`. No file is written unless everything succeeded. Returns 0. Throws fsr::InputError.
int trainTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
