#pragma once

namespace fsr::rheology {

/// Fading memory of first order, tau dm/dt = x - m: a low-pass of the input, a Kelvin-Voigt element.
/// Exact for an input that runs straight between its samples, so that sampling faster changes
/// nothing. The state is one number, kept by the caller; the memory of a body at rest at x for ever
/// is x.
class ExponentialMemory {
 public:
  /// What a step does, for many states that are stepped alike.
  struct Step {
    double fade = 0;    ///< share of the old state that is gone
    double follow = 0;  ///< share of the input's change that has arrived

    /// Value after the input has run straight from `from` to `to`.
    double operator()(double from, double to, double state) const {
      return state + (from - state) * fade + (to - from) * follow;
    }
  };

  /// `time_constant` [s], more than 0 and finite; throws std::invalid_argument.
  explicit ExponentialMemory(double time_constant);

  /// The step over `duration` [s]; over 0 or less nothing happens.
  Step over(double duration) const;

  /// Value after the input has run straight from `from` to `to` within `duration` [s], 0 or more.
  double step(double from, double to, double duration, double state) const {
    return over(duration)(from, to, state);
  }

  double timeConstant() const { return time_constant_; }

 private:
  double time_constant_;
};

}  // namespace fsr::rheology
