#pragma once

#include <ostream>

namespace fsr_ros {

/// The tool `plan_session`: writes a plan for a session at the rig, or describes one. Returns the exit
/// status. Throws fsr::InputError for unusable options and files.
int planSessionTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
