#include <grp.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "protocol/serial_port.h"

namespace fsr::protocol {
namespace {

namespace fs = std::filesystem;

bool startsWith(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

void addEntries(std::vector<std::string>& found, const fs::path& folder, const std::string& start) {
  std::vector<std::string> entries;
  std::error_code ignored;  // a missing folder has no entries
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (startsWith(entry.path().filename().string(), start)) entries.push_back(entry.path().string());
  }
  std::sort(entries.begin(), entries.end());
  found.insert(found.end(), entries.begin(), entries.end());
}

std::string listOf(const std::vector<std::string>& ports) {
  std::string text;
  for (const std::string& port : ports) text += (text.empty() ? "" : ", ") + port;
  return text;
}

std::string missing(const std::string& path) {
  const std::vector<std::string> ports = serialPortCandidates();
  return "there is no serial port " + path + ": " +
         (ports.empty()
              ? "plug the board in (no /dev/serial/by-id/*, /dev/ttyACM* or /dev/ttyUSB* is there either)"
              : "plug the board in, or set serial_port to one that is there: " + listOf(ports));
}

std::string groupOf(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return "dialout";
  const group* entry = getgrgid(status.st_gid);
  return entry != nullptr ? entry->gr_name : std::to_string(status.st_gid);
}

std::string forbidden(const std::string& path) {
  // A port of group root was not assigned to the serial users by udev, e.g. inside a container.
  const std::string group = groupOf(path) == "root" ? "dialout" : groupOf(path);
  return "this user may not open " + path + ": add it to group " + group + " with 'sudo usermod -aG " +
         group + " $USER', then log out and in again";
}

}  // namespace

std::vector<std::string> serialPortCandidates(const std::string& dev) {
  std::vector<std::string> found;
  addEntries(found, dev + "/serial/by-id", "");
  addEntries(found, dev, "ttyACM");
  addEntries(found, dev, "ttyUSB");
  return found;
}

std::string explainOpenError(const std::string& path, int error) {
  const std::string reason = std::string(" (") + std::strerror(error) + ")";
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return missing(path) + reason;
    case EACCES:
    case EPERM:
      return forbidden(path) + reason;
    case EBUSY:
    case EWOULDBLOCK:
      return "another program has " + path + " open: 'fuser -v " + path + "' shows which; close it" + reason;
    case ENOTTY:
    case EISDIR:
      return path + " is not a serial port: set serial_port to the board's" + reason;
    default:
      return "serial port " + path + " does not open" + reason;
  }
}

}  // namespace fsr::protocol
