#include "rheology/memory.h"

#include <algorithm>
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

PrandtlIshlinskii::PrandtlIshlinskii(std::vector<double> radii, std::vector<double> weights)
    : radii_(std::move(radii)), weights_(std::move(weights)) {
  if (radii_.size() != weights_.size()) {
    throw std::invalid_argument("a Prandtl-Ishlinskii operator needs one weight for each radius");
  }
  const bool finite =
      std::all_of(weights_.begin(), weights_.end(), [](double w) { return std::isfinite(w); });
  const bool positive =
      std::all_of(radii_.begin(), radii_.end(), [](double r) { return r >= 0 && std::isfinite(r); });
  if (!finite || !positive) {
    throw std::invalid_argument("a Prandtl-Ishlinskii operator needs radii of 0 or more, all values finite");
  }
}

void PrandtlIshlinskii::reset(double input, double* state) const {
  std::fill(state, state + stateSize(), input);
}

double PrandtlIshlinskii::step(double input, double* state) const {
  double output = 0;
  for (std::size_t i = 0; i < radii_.size(); ++i) {
    state[i] = playStep(input, radii_[i], state[i]);
    output += weights_[i] * state[i];
  }
  return output;
}

}  // namespace fsr::rheology
