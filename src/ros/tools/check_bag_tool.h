#pragma once

#include <ostream>

namespace fsr_ros {

/// `check_bag BAG...`: are recordings fit for training and for discrepancy? `check_bag --use socket BAG...`:
/// what a recording without reference says of itself. The verdict is the last line of `out`. Returns 0
/// whatever it is, or with --strict 1 where it is not the best; throws fsr::InputError where a bag cannot be
/// read.
int checkBagTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
