#pragma once

#include <cstddef>
#include <vector>

namespace fsr::rheology {

/// Fading memory of first order, tau dm/dt = x - m: a low-pass filter of the input, a Kelvin-Voigt element.
/// It is exact for an input that is linear between its samples, so a higher sampling rate changes nothing.
/// The state is one number that the caller stores. After an infinite time at the input x it is x.
class ExponentialMemory {
 public:
  /// A step over a given duration, for many states.
  struct Step {
    double fade = 0;    ///< share of the old state that is lost
    double follow = 0;  ///< share of the input's change that the state has followed

    /// State after the input has changed linearly from `from` to `to`.
    double operator()(double from, double to, double state) const {
      return state + (from - state) * fade + (to - from) * follow;
    }
  };

  /// `time_constant` [s], above 0 and finite, else std::invalid_argument is thrown.
  explicit ExponentialMemory(double time_constant);

  /// The step over `duration` [s]. A duration of 0 or less changes nothing.
  Step over(double duration) const;

  /// State after the input has changed linearly from `from` to `to` within `duration` [s], 0 or more.
  double step(double from, double to, double duration, double state) const {
    return over(duration)(from, to, state);
  }

  double timeConstant() const { return time_constant_; }

 private:
  double time_constant_;
};

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
