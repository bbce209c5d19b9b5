#pragma once

#include <ostream>

namespace fsr_ros {

/// `train BAG... --output FILE`: prints coverage, then scores, then the full path of the file to `out`.
/// Nothing is written unless everything succeeded. Returns 0; throws fsr::InputError.
int trainTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
