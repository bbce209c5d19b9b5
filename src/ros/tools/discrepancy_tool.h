#pragma once

#include <ostream>

namespace fsr_ros {

/// `discrepancy [--simulation FILE] BAG... --output DIR`: where simulation and measurement disagree. And
/// `discrepancy --confirm verdict.yaml NEWBAG...`: whether new bags bear it out. Prints the verdict to
/// `out`; 0 whatever it is, 3 where only the report could not be drawn. Throws fsr::InputError.
int discrepancyTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
