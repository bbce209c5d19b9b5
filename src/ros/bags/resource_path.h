#pragma once

#include <string>

namespace fsr_ros {

/// Resolves a path or URL of a parameter or service to a file:
///
///     /data/calibration.h5               unchanged
///     file:///data/calibration.h5        the same file
///     package://my_rig/calibration.h5    in a package that rospack finds
///     ${ROS_HOME}/calibration.h5         in the directory of ROS, ~/.ros if the variable is not set
///     ~/calibration.h5                   in the user's home directory
///
/// An empty text stays empty. Throws fsr::InputError for a relative path (users do not choose the working
/// directory of a node) and for an unknown package, variable or scheme.
std::string resolveResource(const std::string& text);

/// The same for a parameter of a launch file: a relative path starts in the directory in which the user
/// called roslaunch or rosrun ($PWD, which a node inherits).
std::string resolveLaunchPath(const std::string& text);

/// The directory of ROS for logs and state: $ROS_HOME, or ~/.ros if it is not set.
std::string rosHome();

}  // namespace fsr_ros
