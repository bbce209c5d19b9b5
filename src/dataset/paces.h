#pragma once

#include <vector>

#include "dataset/protocols.h"

namespace fsr::dataset {

/// How the chamber was driven, one entry for each kind of cycle. Cycles are of one kind where speed, dwell
/// and peak differ by no more than kOtherSpeed, kOtherDwell and kOtherPeak. Pressures must be finite.
std::vector<CycleCourse> pacesOf(const std::vector<Recording>& recordings);

/// Whether more than half of the cycles are of one of these kinds.
bool havePaces(const std::vector<Recording>& recordings, const std::vector<CycleCourse>& paces);

}  // namespace fsr::dataset
