#pragma once

#include <cstddef>
#include <vector>

namespace fsr::rheology {

/// Play (backlash) operator: the output follows the input at a distance of at most `radius` and does not
/// change while the input moves within that distance. It is rate-independent: only the turning points of the
/// input matter, not the time between them.
inline double playStep(double input, double radius, double output) {
  if (output < input - radius) return input - radius;
  if (output > input + radius) return input + radius;
  return output;
}

/// Prandtl-Ishlinskii operator: sum_i weight_i play_{radius_i}(input).
/// Source: M. Brokate and J. Sprekels, Hysteresis and Phase Transitions, Springer 1996, ch. 2.
///
/// The operator is constant. The state, one output for each play, is stored by the caller, e.g. one for each
/// taxel, and can be saved and reset. The operator has the wiping-out property: an excursion beyond an
/// earlier turning point erases all memory of that turning point.
class PrandtlIshlinskii {
 public:
  /// `radii` in the unit of the input, 0 or more; `weights` pure numbers, one for each radius.
  /// Throws std::invalid_argument.
  PrandtlIshlinskii(std::vector<double> radii, std::vector<double> weights);

  /// Number of values of a state.
  std::size_t stateSize() const { return radii_.size(); }

  /// Sets the state without memory at `input`. A history that starts from an unloaded body starts at 0.
  void reset(double input, double* state) const;

  /// Changes the state for the new `input` and returns the output. `state` has stateSize() values.
  double step(double input, double* state) const;

 private:
  std::vector<double> radii_;
  std::vector<double> weights_;
};

}  // namespace fsr::rheology
