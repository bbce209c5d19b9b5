#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "rheology/exponential_memory.h"
#include "rheology/play_operator.h"

namespace fsr::compensation {

/// Play operators and fading memories that are driven by one input. The operators are constant; the caller
/// stores the state, one number for each operator, plays first.
class HistoryOperators {
 public:
  /// `radii` [in the unit of the input], `time_constants` [s], each above 0, else std::invalid_argument.
  HistoryOperators(std::vector<double> radii, const std::vector<double>& time_constants);

  std::size_t size() const { return radii_.size() + memories_.size(); }
  std::size_t plays() const { return radii_.size(); }
  std::size_t memories() const { return memories_.size(); }

  /// Sets the state as after a long time at the input `x`.
  void start(double x, double* state) const {
    for (std::size_t k = 0; k < size(); ++k) state[k] = x;
  }

  /// Sets the state for a first input `x` on a sheet that was conditioned: no input is ever below 0, and
  /// there was one above 2 r before. Then a play is never below r, and it lies between max(r, x - r) and x +
  /// r; it starts in the middle. At x = 0 this is x + r: the branch of unloading. Memories start as after a
  /// long time at x.
  void startConditioned(double x, double* state) const {
    start(x, state);
    for (std::size_t j = 0; j < radii_.size(); ++j)
      state[j] = std::max(x, std::min(radii_[j] + x / 2, radii_[j] + x));
  }

  /// The steps of the memories over `duration` [s], 0 or more; `steps` has memories() entries.
  void stepsOver(double duration, rheology::ExponentialMemory::Step* steps) const {
    for (std::size_t k = 0; k < memories_.size(); ++k) steps[k] = memories_[k].over(duration);
  }

  /// Changes the state of the plays for an input that went to `to`.
  void advancePlays(double to, double* state) const {
    for (std::size_t j = 0; j < radii_.size(); ++j) state[j] = rheology::playStep(to, radii_[j], state[j]);
  }

  /// Changes the state for an input that went linearly from `from` to `to`.
  void advance(double from, double to, const rheology::ExponentialMemory::Step* steps, double* state) const {
    advancePlays(to, state);
    double* const memory = state + radii_.size();
    for (std::size_t k = 0; k < memories_.size(); ++k) memory[k] = steps[k](from, to, memory[k]);
  }

 private:
  std::vector<double> radii_;
  std::vector<rheology::ExponentialMemory> memories_;
};

}  // namespace fsr::compensation
