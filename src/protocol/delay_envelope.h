#pragma once

#include <array>
#include <cstddef>

namespace fsr::protocol {

/// (Host time - device time) as a linear function of device time, estimated from arrivals with unknown delays
/// of zero or more. No arrival lies below the line, and the line touches the lower convex hull of the
/// arrivals in the middle of the window. Of all lines below the points this one has the smallest sum of
/// distances to them (Moon, Skelton and Towsley, "Estimation and removal of clock skew from network delay
/// measurements", INFOCOM 1999). An average would depend on the load of the USB bus; the envelope depends on
/// the few arrivals that were not delayed.
///
/// The window contains the lowest arrival of each of 64 slots. A slot is short at first, so that the line is
/// good within a second, and doubles up to `max_slot`. Memory is bounded and nothing is allocated.
class DelayEnvelope {
 public:
  /// `max_slot` [s]: the window is 64 times as long. `max_drift`: largest accepted difference of the clocks'
  /// rates (ratio).
  DelayEnvelope(double max_slot, double max_drift) : max_slot_(max_slot), max_drift_(max_drift) {}

  void clear();

  /// Adds an arrival at device time `x` [s] whose host time is `y` [s] later. One that is older than the
  /// newest slot is ignored.
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
