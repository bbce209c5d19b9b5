#pragma once

#include <array>
#include <cstddef>

namespace fsr::protocol {

/// (Host time - device time) as a constant, estimated from arrivals whose host time scatters in both
/// directions. This is so under a simulated clock: its ticks are messages of their own, so a packet may seem
/// late or early. The estimate is the mean of the middle eight tenths of the last 4096 arrivals that are at
/// least 0.1 s of device time apart. A median would jump between the two values that a coarse clock gives.
/// Both clocks are assumed to be the same one, so no drift is estimated.
class TrimmedDelay {
 public:
  void clear();
  /// Adds an arrival at device time `x` [s] whose host time is `y` [s] later.
  void add(double x, double y);
  /// The delay [s]. Needs one arrival.
  double value() const { return value_; }

 private:
  static constexpr std::size_t kArrivals = 4096;
  static constexpr double kSpacing = 0.1;  // [s]
  static constexpr double kTrim = 0.1;     // of the arrivals, at either end

  void average();

  std::array<double, kArrivals> delays_{};  // [s], a ring buffer
  std::array<double, kArrivals> sorted_{};  // work space
  std::size_t used_ = 0;
  std::size_t next_ = 0;
  std::size_t fresh_ = 0;  // arrivals since the last average
  double last_x_ = 0;
  double value_ = 0;
};

}  // namespace fsr::protocol
