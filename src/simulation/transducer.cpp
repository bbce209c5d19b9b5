#include "fsr_pressure_map/simulation/transducer.h"

#include <algorithm>
#include <cmath>

namespace fsr::simulation {

std::int32_t Transducer::counts(double gauge_pressure) const {
  const double unrounded = std::round((gauge_pressure - low) / step());
  return static_cast<std::int32_t>(std::clamp(unrounded, 0.0, static_cast<double>(full_counts)));
}

}  // namespace fsr::simulation
