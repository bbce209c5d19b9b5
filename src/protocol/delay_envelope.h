#pragma once

#include <array>
#include <cstddef>

namespace fsr::protocol {

/// host time - device time as a straight line of device time, found from arrivals that were delayed by
/// an unknown amount, never by less than nothing: the line that no arrival undercuts and that touches
/// the lower convex hull of the arrivals where the window's middle lies (Moon, Skelton and Towsley,
/// "Estimation and removal of clock skew from network delay measurements", INFOCOM 1999; of all lines
/// below the points that one is the nearest to them on the whole). An average would follow the load of
/// the USB bus; the envelope follows the few arrivals that were not held up.
///
/// The window holds the lowest arrival of each of 64 slots. A slot starts short, so that the line is
/// good within a second, and doubles up to `max_slot` as the run goes on. Bounded memory, no allocation.
class DelayEnvelope {
 public:
  /// `max_slot` [s]: the window is 64 times this. `max_drift`: largest difference of the clocks' rates
  /// that is believed (ratio).
  DelayEnvelope(double max_slot, double max_drift) : max_slot_(max_slot), max_drift_(max_drift) {}

  void clear();

  /// An arrival at device time `x` [s] whose host time is `y` [s] later. One that is older than the
  /// newest slot is left aside.
  void add(double x, double y);

  bool empty() const { return used_ == 0; }
  /// The line at device time `x` [s]. Needs one arrival.
  double at(double x) const { return offset_ + drift_ * x; }
  /// Its slope: how much faster the host's clock runs than the device's (ratio).
  double drift() const { return drift_; }

 private:
  static constexpr std::size_t kSlots = 64;
  static constexpr double kFirstSlot = 1.0 / 16;  // [s]

  struct Arrival {
    double x = 0;  // device time [s]
    double y = 0;  // host - device [s]
  };

  double height(const Arrival& arrival) const { return arrival.y - drift_ * arrival.x; }
  void openSlot(double x);
  void mergePairs();
  std::size_t lowerHull(std::array<Arrival, kSlots>& hull) const;
  double slopeInTheMiddle() const;
  void fit();

  double max_slot_;
  double max_drift_;
  std::array<Arrival, kSlots> lowest_{};  // of each slot, in order of time
  std::size_t used_ = 0;
  double slot_ = kFirstSlot;  // length of a slot [s]
  double slot_end_ = 0;       // of the last one [s]
  double offset_ = 0;         // [s]
  double drift_ = 0;
};

}  // namespace fsr::protocol
