#pragma once

#include <ostream>

namespace fsr_ros {

/// `csv_to_bag TABLE --columns ... --output BAG`: converts a table to a bag, and prints what the bag holds
/// and how readings were converted to counts. Returns 0. Throws fsr::InputError; in that case no bag is left.
int csvToBagTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
