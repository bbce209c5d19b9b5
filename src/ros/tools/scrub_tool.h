#pragma once

#include <ostream>

namespace fsr_ros {

/// `scrub BAG --output BAG`: a copy of a bag without what could tell who, where and when, and lists to `out`
/// what it removed. Kept are scans, chamber pressure, temperature, curvature, maps, matrix, session and
/// events; of those, notes, session id, operator, ethics reference and the labels of notes are taken out, and
/// all times are moved together so that the bag begins on 2000-01-01 00:00 UTC. Everything else (/rosout,
/// /diagnostics, /tf, unknown types), and the names of the nodes that published, stays behind. Returns 0;
/// throws fsr::InputError, and then there is no new bag.
int scrubTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
