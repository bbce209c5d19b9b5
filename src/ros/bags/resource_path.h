#pragma once

#include <string>

namespace fsr_ros {

/// The file that a path or URL stands for, as parameters and services take it:
///
///     /data/calibration.h5               as it is
///     file:///data/calibration.h5        the same
///     package://my_rig/calibration.h5    inside a package that rospack finds
///     ${ROS_HOME}/calibration.h5         the directory of ROS, ~/.ros where the variable is not set
///     ~/calibration.h5                   the user's home
///
/// An empty text stays empty. Throws fsr::InputError where the text cannot mean a file: a relative
/// path (a node's working directory is nobody's choice), an unknown package, variable or scheme.
std::string resolveResource(const std::string& text);

/// ROS's own directory for logs and state: $ROS_HOME, else ~/.ros.
std::string rosHome();

}  // namespace fsr_ros
