#include "rheology/play_operator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace fsr::rheology {

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
