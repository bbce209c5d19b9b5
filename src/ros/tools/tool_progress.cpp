#include "ros/tools/tool_progress.h"

#include <memory>

#include "settings/progress.h"

namespace fsr_ros {

ToolProgress toolProgress() {
  return [progress = std::make_shared<fsr::settings::Progress>()](const std::string& step, double share) {
    progress->report(step, share);
  };
}

}  // namespace fsr_ros
