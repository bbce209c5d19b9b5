#pragma once

#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::simulation {

/// Where on the sheet the pressure acts: everywhere (gas), or under a disc or on one side of an edge
/// (indenter). Uneven loads make effects visible that uniform ones hide, e.g. crosstalk.
struct LoadPattern {
  enum class Kind { kUniform, kDisc, kEdge };
  Kind kind = Kind::kUniform;
  matrix::Position centre;  ///< of the disc; a point of the edge [m]
  double radius = 0;        ///< of the disc [m]
  double angle = 0;         ///< from x to the edge's loaded side [rad]
};

/// Loaded share of the cell of each taxel, which is one pitch wide and high, [rows x columns], row-major.
/// Exactly 1 everywhere for the uniform load.
std::vector<double> loadShares(const LoadPattern& pattern, const matrix::Layout& layout);

}  // namespace fsr::simulation
