#pragma once

#include <ostream>

namespace fsr_ros {

/// `simulate --simulation FILE [--drive BAG...] --output DIR`: bags of a simulated rig, the truth about it
/// beside them, and pictures of what its effects do. Returns 0, or 3 where only the figures could not be
/// drawn; throws fsr::InputError.
int simulateTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
