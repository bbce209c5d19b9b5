#pragma once

#include <array>
#include <cstddef>

namespace fsr::protocol {

/// host time - device time as a constant, found from arrivals whose host time scatters both ways: under a
/// simulated clock that ticks, whose ticks travel as messages of their own, a packet may look late or early.
/// The mean of the middle eight tenths of the last 4096 arrivals, 0.1 s of device time apart at least: a
/// median would jump between the two values that a coarse clock gives. The two clocks are taken to be one, so
/// there is no drift to find.
class TrimmedDelay {
 public:
  void clear();
  /// An arrival at device time `x` [s] whose host time is `y` [s] later.
  void add(double x, double y);
  /// The delay [s]. Needs one arrival.
  double value() const { return value_; }

 private:
  static constexpr std::size_t kArrivals = 4096;
  static constexpr double kSpacing = 0.1;  // [s]
  static constexpr double kTrim = 0.1;     // of the arrivals, at either end

  void average();

  std::array<double, kArrivals> delays_{};  // [s], a ring
  std::array<double, kArrivals> sorted_{};  // room to work in
  std::size_t used_ = 0;
  std::size_t next_ = 0;
  std::size_t fresh_ = 0;  // arrivals since the last average
  double last_x_ = 0;
  double value_ = 0;
};

}  // namespace fsr::protocol
