#pragma once

#include <ostream>

namespace fsr_ros {

/// `study BAG... --output DIR` or `study --simulation FILE --output DIR`: the comparison of Ahmadizadeh and
/// Menon 2019 (doi:10.3390/s19245519), its statistical tests, and further splits and schemes. Writes
/// results.json and tables (CSV) to the folder, then figures and report.html. Prints tables to `out`. With
/// `--shard I/N` it computes a share of the pieces; `--merge` makes the results from those of all shards.
/// Returns 0, or 3 if only the figures could not be drawn. Throws fsr::InputError.
int studyTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
