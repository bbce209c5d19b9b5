#pragma once

#include <string>
#include <vector>

#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Cycles on one surface, or cycles of one protocol of filling and venting.
struct Part {
  std::string name;                 ///< name of the surface, or the common feature of the cycles
  std::vector<std::size_t> cycles;  ///< ascending
};

/// Divides the cycles by surface: one part for each class of curvature that has hold-out cycles. None if
/// there are fewer than two.
std::vector<Part> partsByCondition(const Measured& measured);

/// Divides the cycles by protocol. The parts differ clearly in the speed of the ramps. If no speeds differ,
/// the parts differ in the dwell time under load, and otherwise in the peak. None if all cycles are alike.
std::vector<Part> partsByProtocol(const Measured& measured);

/// The recordings with all cycles of a part held out. A fit to them does not use the part.
Measured withoutPart(const Measured& measured, const Part& part);

}  // namespace fsr::discrepancy
