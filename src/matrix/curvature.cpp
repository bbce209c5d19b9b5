#include "fsr_pressure_map/matrix/curvature.h"

#include <cmath>

namespace fsr {

bool operator==(const Curvature& a, const Curvature& b) {
  return a.x == b.x && a.y == b.y && a.xy == b.xy;
}

double principalCurvature(const Curvature& curvature) {
  const double mean = 0.5 * (curvature.x + curvature.y);
  const double radius = std::hypot(0.5 * (curvature.x - curvature.y), curvature.xy);
  return mean >= 0 ? mean + radius : mean - radius;
}

bool sameCondition(const Surface& a, const Surface& b) {
  return a.name == b.name && a.mount == b.mount && a.curvature == b.curvature;
}

}  // namespace fsr
