#pragma once

#include <ostream>

namespace fsr_ros {

/// `close_bag FILE.bag.active...` closes recordings whose recorder died or whose disk was full (rescueBag()).
/// Returns 0, or 1 if there was no room for the index of one. Throws fsr::InputError.
int closeBagTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
