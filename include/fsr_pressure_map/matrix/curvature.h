#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::matrix {

/// Curvature tensor of the surface under one taxel [1/m], in the matrix frame. It is positive where the
/// sheet is convex towards +z, e.g. wrapped round a limb phantom and loaded from outside. It is negative on
/// the inside of a socket wall.
struct Curvature {
  double x = 0;   ///< of the section through a row
  double y = 0;   ///< of the section through a column
  double xy = 0;  ///< twist
};

bool operator==(const Curvature& a, const Curvature& b);

/// The principal curvature of [[x, xy], [xy, y]] with the largest magnitude, with its sign [1/m]. Of two with
/// the same magnitude it is the positive one. Schemes with one curvature input use this scalar.
double principalCurvature(const Curvature& curvature);

/// The surface that the matrix lies on.
struct Surface {
  std::string name;                  ///< e.g. cylinder_7cm; may be empty
  std::uint32_t mount = 0;           ///< increases by one at each mounting; 0 = unknown
  std::vector<Curvature> curvature;  ///< one for all taxels, or one for each, row-major; empty = unknown
  std::vector<double> deviation;     ///< standard deviation [1/m], one or one for each taxel; empty = unknown

  bool known() const { return !curvature.empty(); }
  const Curvature& at(TaxelIndex taxel) const {
    return curvature.size() == 1 ? curvature.front() : curvature.at(taxel.value);
  }
  /// [1/m]; 0 if unknown.
  double deviationAt(TaxelIndex taxel) const {
    if (deviation.empty()) return 0;
    return deviation.size() == 1 ? deviation.front() : deviation.at(taxel.value);
  }
};

/// Throws InputError unless the surface has no, one or `size` curvatures, and no, one or `size` deviations.
void requireFit(const Surface& surface, MatrixSize size);

/// Whether name, mount and curvature are equal. Deviations are not compared.
bool sameCondition(const Surface& a, const Surface& b);

}  // namespace fsr::matrix
