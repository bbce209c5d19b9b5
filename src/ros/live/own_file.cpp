#include "ros/live/own_file.h"

#include <algorithm>

#include "ros/bags/resource_path.h"

namespace fsr_ros {

std::string ownFile(const Parameters& parameters, const std::string& name, const std::string& node,
                    const std::string& what) {
  const std::string given = parameters.text(name, "");
  if (!given.empty()) return resolveLaunchPath(given);
  std::string file = node.substr(node.find_first_not_of('/'));
  std::replace(file.begin(), file.end(), '/', '_');
  return resolveResource("${ROS_HOME}/fsr_pressure_map/" + file + "_" + what + ".yaml");
}

}  // namespace fsr_ros
