#include "fsr_pressure_map/rheology/exponential_memory.h"

#include <cmath>
#include <stdexcept>

namespace fsr {

ExponentialMemory::ExponentialMemory(double time_constant) : time_constant_(time_constant) {
  if (!(time_constant > 0) || !std::isfinite(time_constant)) {
    throw std::invalid_argument("a memory needs a time constant of more than 0 s");
  }
}

double ExponentialMemory::step(double from, double to, double duration, double state) const {
  if (duration <= 0) return state;
  // m(t) of a ramp with slope s: x(t) - s tau + (m0 - x0 + s tau) exp(-t / tau). The same, written
  // without the difference of large numbers that a short step would leave:
  const double ratio = duration / time_constant_;
  const double gone = -std::expm1(-ratio);  // 1 - exp(-ratio)
  return state + (from - state) * gone + (to - from) * (1 - gone / ratio);
}

}  // namespace fsr
