#pragma once

#include <functional>
#include <string>

namespace fsr_ros {

using ToolProgress = std::function<void(const std::string& step, double share)>;

/// Shows on stderr what a tool does, the share that is done, and the time left (settings::Progress). The line
/// is removed when the last copy of the function is destroyed.
ToolProgress toolProgress();

}  // namespace fsr_ros
