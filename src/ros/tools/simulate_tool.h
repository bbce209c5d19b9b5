#pragma once

#include <ostream>

namespace fsr_ros {

/// `simulate --simulation FILE [--drive BAG...] --output DIR`: writes bags of a simulated rig and its true
/// settings (truth.yaml), or pictures of its effects; or recomputes the gap of a verdict (--gap). Returns 0,
/// or 3 if only the figures could not be drawn. Throws fsr::InputError.
int simulateTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
