#pragma once

#include <cstdint>
#include <string>

namespace fsr_ros {

/// Counts how often the held-out part of a bag was looked at: a proof on data that somebody looked at
/// twenty times is none. One small file for each bag, named by the SHA-256 of its bytes, in
/// ROS_HOME/fsr_pressure_map/show_opened (~/.ros where ROS_HOME is not set), so that neither another output
/// folder nor another name of the bag begins anew; each look adds a line (date and seed, nothing else).
class ShowLedger {
 public:
  ShowLedger();
  explicit ShowLedger(std::string folder) : folder_(std::move(folder)) {}

  /// Notes one look and returns how many there were, this one included. Throws fsr::InputError where it
  /// cannot be written.
  int open(const std::string& sha256, std::uint64_t seed) const;
  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
};

}  // namespace fsr_ros
