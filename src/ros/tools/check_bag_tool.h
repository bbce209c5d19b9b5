#pragma once

#include <ostream>

namespace fsr_ros {

/// `check_bag BAG...` checks whether recordings can be used for training and for discrepancy. `check_bag
/// --use socket BAG...` checks a recording without reference. The verdict is the last line of `out`. Returns
/// 0 whatever the verdict is, or with --strict 1 if it is not good. Throws fsr::InputError if a bag cannot be
/// read.
int checkBagTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
