#pragma once

#include <ostream>

namespace fsr_ros {

/// The tool day_report: runs check_bag, train and discrepancy on the bags of a conducted session, and writes
/// the report of the day. A tool that refuses the bags appears in the report with its sentence. Throws
/// fsr::InputError; returns the exit status.
int dayReportTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
