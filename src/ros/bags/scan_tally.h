#pragma once

#include <fsr_pressure_map/MatrixFrame.h>

#include <cstdint>
#include <string>

namespace fsr_ros {

/// Counts the scans of a recording.
class ScanTally {
 public:
  void add(const fsr_pressure_map::MatrixFrame& scan);

  std::uint64_t scans() const { return scans_; }
  /// "412 scans in 41.2 s (3 lost by the board's counter)".
  std::string text() const;

 private:
  std::uint64_t scans_ = 0;
  std::uint64_t lost_ = 0;
  std::uint32_t sequence_ = 0;  // of the last scan
  double first_ = 0;            // stamp [s]
  double last_ = 0;             // stamp [s]
};

}  // namespace fsr_ros
