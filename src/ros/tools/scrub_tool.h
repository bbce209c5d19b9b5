#pragma once

#include <ostream>

namespace fsr_ros {

/// `scrub BAG --output BAG`: copies a bag without data that could identify persons, places or dates, and
/// prints to `out` what was removed. The copy has scans, chamber pressure, temperature, curvature, maps,
/// matrix, session and events. From these, notes, session id, operator, ethics reference and the labels of
/// notes are removed, and all times are moved together so that the bag begins on 2000-01-01 00:00 UTC.
/// Everything else (/rosout, /diagnostics, /tf, unknown types) and the names of the publishing nodes are not
/// copied. Returns 0. Throws fsr::InputError; in that case no new bag is left.
int scrubTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
