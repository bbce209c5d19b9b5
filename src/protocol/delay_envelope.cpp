#include "protocol/delay_envelope.h"

#include <algorithm>

namespace fsr::protocol {

void DelayEnvelope::clear() {
  used_ = 0;
  slot_ = kFirstSlot;
  offset_ = 0;
  drift_ = 0;
}

void DelayEnvelope::add(double x, double y) {
  const Arrival arrival = {x, y};
  if (used_ > 0 && x < slot_end_ - slot_) return;  // older than the newest slot
  if (used_ == 0 || x >= slot_end_) {
    openSlot(x);
    lowest_[used_++] = arrival;
  } else if (height(arrival) < height(lowest_[used_ - 1])) {
    lowest_[used_ - 1] = arrival;
  } else {
    return;  // the slot has a lower arrival
  }
  fit();
}

// Makes room for one more slot, which starts at or just before `x`.
void DelayEnvelope::openSlot(double x) {
  if (used_ == kSlots && slot_ < max_slot_) mergePairs();
  if (used_ == kSlots) {
    std::copy(lowest_.begin() + 1, lowest_.end(), lowest_.begin());
    --used_;
  }
  slot_end_ = used_ == 0 || x >= slot_end_ + slot_ ? x + slot_ : slot_end_ + slot_;
}

void DelayEnvelope::mergePairs() {
  for (std::size_t i = 0; i < kSlots / 2; ++i) {
    const Arrival& a = lowest_[2 * i];
    const Arrival& b = lowest_[2 * i + 1];
    lowest_[i] = height(a) <= height(b) ? a : b;
  }
  used_ = kSlots / 2;
  slot_ = std::min(2 * slot_, max_slot_);
}

// Andrew's monotone chain, lower half; returns the number of corners.
std::size_t DelayEnvelope::lowerHull(std::array<Arrival, kSlots>& hull) const {
  std::size_t corners = 0;
  const auto turnsUp = [](const Arrival& a, const Arrival& b, const Arrival& c) {
    return (b.x - a.x) * (c.y - a.y) > (b.y - a.y) * (c.x - a.x);
  };
  for (std::size_t i = 0; i < used_; ++i) {
    while (corners >= 2 && !turnsUp(hull[corners - 2], hull[corners - 1], lowest_[i])) --corners;
    hull[corners++] = lowest_[i];
  }
  return corners;
}

double DelayEnvelope::slopeInTheMiddle() const {
  std::array<Arrival, kSlots> hull;
  const std::size_t corners = lowerHull(hull);
  const double middle = (lowest_[0].x + lowest_[used_ - 1].x) / 2;
  for (std::size_t i = 1; i < corners; ++i) {
    if (hull[i].x < middle && i + 1 < corners) continue;
    const double length = hull[i].x - hull[i - 1].x;
    return length > 0 ? (hull[i].y - hull[i - 1].y) / length : 0;
  }
  return 0;
}

void DelayEnvelope::fit() {
  drift_ = std::clamp(slopeInTheMiddle(), -max_drift_, max_drift_);
  offset_ = height(lowest_[0]);
  for (std::size_t i = 1; i < used_; ++i) offset_ = std::min(offset_, height(lowest_[i]));
}

}  // namespace fsr::protocol
