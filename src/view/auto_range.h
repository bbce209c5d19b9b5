#pragma once

namespace fsr::view {

/// Upper end of a scale that follows the data without flicker: it stands on a few round values (1, 2, 5
/// times a power of ten), grows at once when a peak passes it, and steps down only after the peaks have
/// stayed below 80 % of the next lower value for `patience`.
class AutoRange {
 public:
  /// `least`: the smallest end that is ever used [Pa]; `patience` [s].
  explicit AutoRange(double least = 10e3, double patience = 5.0);

  /// Takes the peak of one map [Pa] (NaN is left out) at `time` [s]; returns the scale's upper end [Pa].
  /// Time that runs back (a looped bag) starts the patience anew.
  double update(double time, double peak);

 private:
  double least_;
  double patience_;
  double high_;
  double calm_since_ = 0;  // [s]
  bool calm_ = false;
};

}  // namespace fsr::view
