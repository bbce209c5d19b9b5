#pragma once

#include <optional>

#include "conductor/step_watch.h"

namespace fsr::conductor {

/// Times at which a rise from `low` to `peak`, and the fall behind it, cross 10 % and 90 % of the way,
/// interpolated between readings. The paces are the mean ones between these two levels.
class LevelCrossings {
 public:
  LevelCrossings(double low, double peak);

  void take(const Reading& reading);

  double lowLevel() const { return low_level_; }    ///< 10 % [Pa]
  double highLevel() const { return high_level_; }  ///< 90 % [Pa]
  /// Pace of the rise, once it has crossed 90 % [Pa/s].
  std::optional<double> fillRate() const;
  /// Pace of the fall, once it has crossed 10 % [Pa/s].
  std::optional<double> ventRate() const;
  /// Time from crossing 90 % upwards to crossing it downwards, or to the last reading [s].
  double timeAbove() const;
  /// "The chamber stays at ...", where the pressure has not risen for a while below 90 %.
  Hint stalledHint(double peak) const;

 private:
  const double low_level_, high_level_;
  std::optional<Reading> last_;
  std::optional<double> up_low_, up_high_, down_high_, down_low_;  // [s]
  double highest_ = 0;  // when it had risen by 1 % of the way last: pressure [Pa]
  double risen_ = 0;    // and time [s]
};

}  // namespace fsr::conductor
