#pragma once

#include <cstddef>
#include <vector>

namespace fsr::rheology {

/// Play (backlash) operator: the output follows the input at a distance of at most `radius`, and
/// stands still while the input moves inside that gap. Rate-independent: only the turning points of
/// the input count, never the time between them.
inline double playStep(double input, double radius, double output) {
  if (output < input - radius) return input - radius;
  if (output > input + radius) return input + radius;
  return output;
}

/// Prandtl-Ishlinskii operator: sum_i weight_i play_{radius_i}(input).
/// Source: M. Brokate and J. Sprekels, Hysteresis and Phase Transitions, Springer 1996, ch. 2.
///
/// The operator itself never changes; the state, one play output each, belongs to the caller, who can
/// keep one for each taxel, save it and reset it. It wipes out: an excursion beyond an earlier turning
/// point erases all memory of that turning point.
class PrandtlIshlinskii {
 public:
  /// `radii` in the unit of the input, 0 or more; `weights` pure numbers, one for each radius.
  /// Throws std::invalid_argument.
  PrandtlIshlinskii(std::vector<double> radii, std::vector<double> weights);

  /// Number of values of a state.
  std::size_t stateSize() const { return radii_.size(); }

  /// The state after resting at `input` for ever, all memory gone. Where the history starts from an
  /// unloaded body, reset at 0.
  void reset(double input, double* state) const;

  /// Moves on to `input` and returns the output. `state` holds stateSize() values.
  double step(double input, double* state) const;

  /// Vertical distance of the two branches of a loop so wide that every play has been turned round:
  /// 2 sum_i weight_i radius_i.
  double fullLoopWidth() const;
  /// Area of the loop between two turning points: sum_i 2 weight_i radius_i max(b - a - 2 radius_i, 0).
  double loopArea(double low, double high) const;

 private:
  std::vector<double> radii_;
  std::vector<double> weights_;
};

}  // namespace fsr::rheology
