#pragma once

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

}  // namespace fsr::rheology
