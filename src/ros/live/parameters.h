#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/range.h"
#include "settings/foreign_error.h"
#include "settings/settings.h"

namespace fsr_ros {

/// Reads and checks the private parameters of a node. A value of the wrong type or out of range raises
/// fsr::InputError, which names the parameter with its full path, its value and what would be right. Every
/// parameter has a default.
///
/// The parameter `~rig` may name a rig file, whose values then replace those of the launch file, except for
/// the arguments that the user gave to roslaunch: `~launched`, which scripts/launch_check writes, lists them.
class Parameters {
 public:
  /// `arguments`: the argument of the launch file for each parameter that has another name; "" = the rig file
  /// does not set this parameter. Throws fsr::InputError if the rig file cannot be read.
  explicit Parameters(const ros::NodeHandle& private_handle,
                      std::map<std::string, std::string> arguments = {});

  double number(const std::string& name, double fallback, const fsr::settings::Range& range) const;
  std::int64_t integer(const std::string& name, std::int64_t fallback,
                       const fsr::settings::Range& range) const;
  bool flag(const std::string& name, bool fallback) const;
  /// A number is converted to its text, so that `_trial:=3` works.
  std::string text(const std::string& name, const std::string& fallback) const;
  std::string choice(const std::string& name, const std::vector<std::string>& choices,
                     const std::string& fallback) const;

  /// Warns of private parameters that are set, but were not read. Call it after all parameters have been
  /// read, because a misspelt one would otherwise be ignored without a message. `node`: e.g. "view node".
  void warnOfUnknown(const std::string& node) const;

  /// An InputError about a parameter: "parameter /fsr/driver/rows is 90, but " + `complaint`; or about the
  /// rig file, where the value is in it.
  [[nodiscard]] fsr::settings::InputError error(const std::string& name, const std::string& complaint) const;

 private:
  bool isSet(const std::string& name) const;
  std::string argumentOf(const std::string& name) const;
  bool isOfRig(const std::string& name) const;

  ros::NodeHandle handle_;
  std::optional<fsr::settings::Settings> rig_;
  std::map<std::string, std::string> arguments_;
  std::set<std::string> given_;          // arguments of the command line
  mutable std::set<std::string> asked_;  // full paths
};

/// Runs the main part of a node. An exception is logged as one fatal line and gives exit status 2.
template <typename Run>
int runNode(Run run) {
  const ros::NodeHandle
      keeps_the_log_open;  // destroying the last handle would close the log before the message
  try {
    fsr::settings::inSentences(run);
    return 0;
  } catch (const fsr::settings::InputError& error) {
    ROS_FATAL_STREAM(error.what());
    return 2;
  }
}

/// Path of a file in which a node keeps `what` from one run to the next: the parameter `name`, or, where it
/// is not set or empty (as in the launch files), a file of its own for each node: /fsr/calibration and "tare"
/// give
/// ${ROS_HOME}/fsr_pressure_map/fsr_calibration_tare.yaml. Throws fsr::InputError.
std::string ownFile(const Parameters& parameters, const std::string& name, const std::string& node,
                    const std::string& what);

}  // namespace fsr_ros
