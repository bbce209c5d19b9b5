#pragma once

#include <ostream>

namespace fsr_ros {

/// `study BAG... --output DIR` or `study --simulation FILE --output DIR`: the paper's comparison, its tests,
/// and what they leave out. Writes results.json and tables (CSV) to the folder, then figures and
/// report.html; prints tables to `out`. Returns 0, or 3 where only the figures could not be drawn; throws
/// fsr::InputError.
int studyTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
