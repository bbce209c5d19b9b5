#include "ros/bags/resource_path.h"

#include <ros/package.h>

#include <cstdlib>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

namespace {

bool takePrefix(std::string& text, const std::string& prefix) {
  if (text.rfind(prefix, 0) != 0) return false;
  text.erase(0, prefix.size());
  return true;
}

std::string userHome() {
  const char* home = std::getenv("HOME");
  return home != nullptr ? home : "";
}

// package://NAME/REST without its scheme.
std::string insidePackage(const std::string& rest, const std::string& url) {
  const std::size_t slash = rest.find('/');
  const std::string name = rest.substr(0, slash);
  const std::string folder = name.empty() ? "" : ros::package::getPath(name);
  if (folder.empty()) {
    throw fsr::settings::InputError(url + ": there is no package \"" + name +
                                    "\" in ROS_PACKAGE_PATH; name one that rospack finds");
  }
  return slash == std::string::npos ? folder : folder + rest.substr(slash);
}

}  // namespace

std::string rosHome() {
  const char* home = std::getenv("ROS_HOME");
  return home != nullptr && *home != '\0' ? home : userHome() + "/.ros";
}

std::string resolveResource(const std::string& text) {
  std::string rest = text;
  if (takePrefix(rest, "package://")) return insidePackage(rest, text);
  takePrefix(rest, "file://");
  if (takePrefix(rest, "${ROS_HOME}")) return rosHome() + rest;
  if (rest == "~" || rest.rfind("~/", 0) == 0) return userHome() + rest.substr(1);
  if (!rest.empty() && rest.front() != '/') {
    throw fsr::settings::InputError(text +
                                    ": give an absolute path, or one that starts with package://, file://, " +
                                    "${ROS_HOME} or ~/");
  }
  return rest;
}

std::string resolveLaunchPath(const std::string& text) {
  const bool relative = !text.empty() && text.front() != '/' && text.front() != '~' && text.front() != '$' &&
                        text.find("://") == std::string::npos;
  const char* folder = std::getenv("PWD");
  if (!relative || folder == nullptr || *folder != '/') return resolveResource(text);
  return std::string(folder) + "/" + text;
}

}  // namespace fsr_ros
