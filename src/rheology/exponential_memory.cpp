#include "rheology/exponential_memory.h"

#include <cmath>
#include <stdexcept>

namespace fsr::rheology {

ExponentialMemory::ExponentialMemory(double time_constant) : time_constant_(time_constant) {
  if (!(time_constant > 0) || !std::isfinite(time_constant)) {
    throw std::invalid_argument("a memory needs a time constant of more than 0 s");
  }
}

ExponentialMemory::Step ExponentialMemory::over(double duration) const {
  if (duration <= 0) return {};
  // For a ramp with slope s, m(t) = x(t) - s tau + (m0 - x0 + s tau) exp(-t / tau). The form below is the
  // same without the difference of large numbers that a short step would cause:
  const double ratio = duration / time_constant_;
  const double gone = -std::expm1(-ratio);  // 1 - exp(-ratio)
  return {gone, 1 - gone / ratio};
}

}  // namespace fsr::rheology
