#pragma once

#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::simulation {

/// Where on the sheet the pressure acts: everywhere, as gas does, or under a disc or beside an edge, as
/// an indenter does. Uneven loads show what uniform ones cannot: crosstalk, and the map.
struct LoadPattern {
  enum class Kind { kUniform, kDisc, kEdge };
  Kind kind = Kind::kUniform;
  matrix::Position centre;  ///< of the disc; a point of the edge [m]
  double radius = 0;        ///< of the disc [m]
  double angle = 0;         ///< from x to the edge's loaded side [rad]
};

/// Share of each taxel's cell, pitch by pitch, that is loaded, [rows x columns], row-major; exactly 1
/// everywhere for the uniform load.
std::vector<double> loadShares(const LoadPattern& pattern, const matrix::Layout& layout);

}  // namespace fsr::simulation
