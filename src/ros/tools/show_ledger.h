#pragma once

#include <cstdint>
#include <string>

namespace fsr_ros {

/// Counts how often the hold-out (show) cycles of a bag were used: a test on data that was used twenty times
/// proves little. There is one small file for each bag in ROS_HOME/fsr_pressure_map/show_opened (~/.ros if
/// ROS_HOME is not set). Its name is the SHA-256 of the bag, so that the count does not depend on the output
/// folder or on the name of the bag. Each use adds one line with date and seed.
class ShowLedger {
 public:
  ShowLedger();
  explicit ShowLedger(std::string folder) : folder_(std::move(folder)) {}

  /// Adds one use and returns the number of uses, including this one. Throws fsr::InputError if the file
  /// cannot be written.
  int open(const std::string& sha256, std::uint64_t seed) const;
  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
};

}  // namespace fsr_ros
