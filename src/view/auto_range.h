#pragma once

namespace fsr::view {

/// Upper end of a scale that follows the data without flicker. It takes round values only (1, 2 or 5 times a
/// power of ten). It rises at once when a peak exceeds it. It falls to the next lower value only after all
/// peaks stayed below 80 % of that value for `patience`.
class AutoRange {
 public:
  /// `least`: smallest upper end [Pa]; `patience` [s].
  explicit AutoRange(double least = 10e3, double patience = 5.0);

  /// Adds the peak of one map [Pa] at `time` [s] and returns the scale's upper end [Pa]. A NaN peak is
  /// ignored. If the time jumps back (a looped bag), the wait for the next step down starts again.
  double update(double time, double peak);

 private:
  double least_;
  double patience_;
  double high_;
  double calm_since_ = 0;  // [s]
  bool calm_ = false;
};

}  // namespace fsr::view
