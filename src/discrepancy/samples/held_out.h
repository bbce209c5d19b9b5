#pragma once

#include <string>
#include <vector>

#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Cycles of one surface, or of one way to fill and vent.
struct Part {
  std::string name;                 ///< of the surface, or what the cycles have in common
  std::vector<std::size_t> cycles;  ///< ascending
};

/// By surface: one part for each class of curvature; none where there is only one.
std::vector<Part> partsByCondition(const Measured& measured);

/// By protocol: cycles that differ clearly in the speed of their ramps, else in how long they dwell under
/// load, else in their peak; none where all are alike.
std::vector<Part> partsByProtocol(const Measured& measured);

/// The recordings, with the cycles of a part among the hold-out cycles: what is fitted to them has not seen
/// it.
Measured withoutPart(const Measured& measured, const Part& part);

}  // namespace fsr::discrepancy
