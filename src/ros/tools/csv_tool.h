#pragma once

#include <ostream>

namespace fsr_ros {

/// `csv_to_bag TABLE --columns ... --output BAG`: prints what the bag holds and how readings became
/// counts to `out`. Returns 0; throws fsr::InputError, and then there is no bag.
int csvToBagTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
