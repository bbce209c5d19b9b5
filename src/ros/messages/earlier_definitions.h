#pragma once

#include <string>

namespace fsr_ros {

/// Whether a message type of this package once had the definition of this MD5 sum, with the same fields in
/// the same order as today. ROS counts a new constant as another definition, but the recorded bytes are the
/// same, so bags with such definitions are read as they are. The rules in migration/ tell `rosbag fix` how to
/// convert them for programs that compare the sums, e.g. nodes that subscribe to what `rosbag play` plays.
bool hadDefinition(const std::string& type, const std::string& md5sum);

}  // namespace fsr_ros
