#include "protocol/trimmed_delay.h"

#include <algorithm>
#include <numeric>

namespace fsr::protocol {

void TrimmedDelay::clear() {
  used_ = next_ = fresh_ = 0;
}

void TrimmedDelay::add(double x, double y) {
  if (used_ > 0 && x < last_x_ + kSpacing) return;
  last_x_ = x;
  delays_[next_] = y;
  next_ = (next_ + 1) % kArrivals;
  used_ = std::min(used_ + 1, kArrivals);
  // Sorts again when a tenth of the arrivals are new.
  if (++fresh_ * 10 < used_) return;
  fresh_ = 0;
  average();
}

void TrimmedDelay::average() {
  const auto trimmed = static_cast<std::ptrdiff_t>(kTrim * static_cast<double>(used_));
  std::copy_n(delays_.begin(), used_, sorted_.begin());
  const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(used_);
  const auto low = sorted_.begin() + trimmed;
  const auto high = end - trimmed;
  std::nth_element(sorted_.begin(), low, end);
  std::nth_element(low, high - 1, end);
  value_ = std::accumulate(low, high, 0.0) / static_cast<double>(high - low);
}

}  // namespace fsr::protocol
