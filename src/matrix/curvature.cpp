#include "fsr_pressure_map/matrix/curvature.h"

#include <cmath>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::matrix {

bool operator==(const Curvature& a, const Curvature& b) {
  return a.x == b.x && a.y == b.y && a.xy == b.xy;
}

double principalCurvature(const Curvature& curvature) {
  const double mean = 0.5 * (curvature.x + curvature.y);
  const double radius = std::hypot(0.5 * (curvature.x - curvature.y), curvature.xy);
  return mean >= 0 ? mean + radius : mean - radius;
}

void requireFit(const Surface& surface, MatrixSize size) {
  for (const std::size_t values : {surface.curvature.size(), surface.deviation.size()}) {
    if (values > 1 && values != size.taxels()) {
      throw settings::InputError("surface \"" + surface.name + "\" has " + std::to_string(values) +
                                 " values, but must have one, or one for each of the " +
                                 std::to_string(size.taxels()) + " taxels of a " + sizeText(size) +
                                 " matrix");
    }
  }
}

bool sameCondition(const Surface& a, const Surface& b) {
  return a.name == b.name && a.mount == b.mount && a.curvature == b.curvature;
}

}  // namespace fsr::matrix
