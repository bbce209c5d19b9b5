#pragma once

#include <ostream>

namespace fsr_ros {

/// `discrepancy [--simulation FILE] BAG... --output DIR` finds where simulation and measurement disagree.
/// `discrepancy --confirm verdict.yaml NEWBAG...` tests the prediction of a verdict on new bags. Prints the
/// verdict to `out`. Returns 0 whatever the verdict is, or 3 if only the report could not be drawn. Throws
/// fsr::InputError.
int discrepancyTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
