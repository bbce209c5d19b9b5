#include "ros/bags/scan_tally.h"

#include <algorithm>

#include "settings/number_text.h"

namespace fsr_ros {

void ScanTally::add(const fsr_pressure_map::MatrixFrame& scan) {
  const double stamp = scan.header.stamp.toSec();
  const std::uint32_t step = scan.sequence - sequence_;
  // A step back is a restart of the board, which says nothing about lost scans.
  constexpr std::uint32_t kBack = 1u << 31;
  if (scans_ > 0 && step > 1 && step < kBack) lost_ += step - 1;
  if (scans_ == 0) first_ = stamp;
  sequence_ = scan.sequence;
  last_ = std::max(last_, stamp);
  ++scans_;
}

std::string ScanTally::text() const {
  return std::to_string(scans_) + (scans_ == 1 ? " scan in " : " scans in ") +
         fsr::settings::fixedText(scans_ > 0 ? std::max(0.0, last_ - first_) : 0.0, 1) + " s (" +
         std::to_string(lost_) + " lost by the board's counter)";
}

}  // namespace fsr_ros
