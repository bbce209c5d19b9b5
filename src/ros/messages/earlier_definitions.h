#pragma once

#include <cstddef>
#include <string>

namespace fsr_ros {

/// Whether a message type of this package once had the definition of this MD5 sum, with the same fields in
/// the same order as today. ROS counts a new constant as another definition, but the recorded bytes are the
/// same, so bags with such definitions are read as they are. The rules in migration/ tell `rosbag fix` how to
/// convert them for programs that compare the sums, e.g. nodes that subscribe to what `rosbag play` plays.
bool hadDefinition(const std::string& type, const std::string& md5sum);

/// Number of texts that were added at the end of a message type since it had the definition of this MD5 sum;
/// 0 = it never had this definition, or nothing was added. Recorded bytes are read with so many empty texts
/// behind them.
std::size_t fieldsAdded(const std::string& type, const std::string& md5sum);

}  // namespace fsr_ros
