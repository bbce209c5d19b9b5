#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::matrix {

/// Curvature tensor of the surface under one taxel [1/m], in the matrix frame. Positive where the
/// sheet is convex towards +z (wrapped round a limb phantom and loaded from outside), negative on
/// the inside of a socket wall.
struct Curvature {
  double x = 0;   ///< of the section through a row
  double y = 0;   ///< of the section through a column
  double xy = 0;  ///< twist
};

bool operator==(const Curvature& a, const Curvature& b);

/// The principal curvature of largest magnitude of [[x, xy], [xy, y]], sign kept [1/m]; of two of
/// one magnitude the positive one. This is the scalar that schemes of one curvature input use.
double principalCurvature(const Curvature& curvature);

/// What the matrix lies on.
struct Surface {
  std::string name;                  ///< e.g. cylinder_7cm; may be empty
  std::uint32_t mount = 0;           ///< raised by one at each remounting; 0 = unknown
  std::vector<Curvature> curvature;  ///< one for all taxels, or one each, row-major; empty = unknown
  std::vector<double> deviation;     ///< one standard deviation [1/m], likewise; empty = unknown

  bool known() const { return !curvature.empty(); }
  const Curvature& at(TaxelIndex taxel) const {
    return curvature.size() == 1 ? curvature.front() : curvature.at(taxel.value);
  }
};

/// Throws InputError where a surface has neither none, one nor `size` curvatures or deviations.
void requireFit(const Surface& surface, MatrixSize size);

/// Same name, mount and curvature (deviation left aside).
bool sameCondition(const Surface& a, const Surface& b);

}  // namespace fsr::matrix
