#include "protocol/serial_port.h"

#include "settings/text.h"

#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace fsr::protocol {

// Sets any rate; in serial_speed.cpp. False, with errno set, on failure.
bool setUnnamedSpeed(int descriptor, std::uint32_t baud);

namespace {

std::string reason(int error) {
  return std::strerror(error);
}

// Whether this is the slave side of a pseudo-terminal, also where it was opened through a link.
bool isPseudoTerminal(int descriptor) {
  char name[64] = "";
  return ttyname_r(descriptor, name, sizeof(name)) == 0 && std::strncmp(name, "/dev/pts/", 9) == 0;
}

// TIOCEXCL excludes other users; the lock also excludes programs of the superuser that use it.
bool claim(int descriptor) {
  return flock(descriptor, LOCK_EX | LOCK_NB) == 0 && ioctl(descriptor, TIOCEXCL) == 0;
}

// 8N1, no flow control, no translation, no hang-up at close (it would reset many boards).
bool makeRaw(int descriptor) {
  termios settings{};
  if (tcgetattr(descriptor, &settings) != 0) return false;
  cfmakeraw(&settings);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | CRTSCTS | HUPCL);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  return tcsetattr(descriptor, TCSANOW, &settings) == 0;
}

// Uses the named rate where there is one, so that every program reads the same rate back.
bool setSpeed(int descriptor, std::uint32_t baud) {
  termios settings{};
  if (tcgetattr(descriptor, &settings) != 0) return false;
  if (cfsetspeed(&settings, baud) != 0) return setUnnamedSpeed(descriptor, baud);
  return tcsetattr(descriptor, TCSANOW, &settings) == 0;
}

}  // namespace

SerialPort::SerialPort(const std::string& path, std::uint32_t baud, HostClock now)
    : path_(path), now_(std::move(now)) {
  descriptor_ = open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) throw LinkError(explainOpenError(path, errno));
  try {
    configure(baud);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

SerialPort::~SerialPort() {
  ioctl(descriptor_, TIOCNXCL);
  close(descriptor_);
}

void SerialPort::configure(std::uint32_t baud) {
  if (isatty(descriptor_) == 0) throw LinkError(explainOpenError(path_, ENOTTY));
  if (!claim(descriptor_)) throw LinkError(explainOpenError(path_, EBUSY));
  if (!makeRaw(descriptor_)) fail("does not accept raw mode");
  if (baud != 0 && !setSpeed(descriptor_, baud)) {
    fail("does not accept " + std::to_string(baud) + " baud: set serial_baud to the board's own rate");
  }
  if (!isPseudoTerminal(descriptor_)) baud_ = baud;
  tcflush(descriptor_,
          TCIFLUSH);  // the arrival of bytes from before the port was opened is unknown
}

void SerialPort::fail(const std::string& what) const {
  throw LinkError("serial port " + path_ + " " + what + " (" + reason(errno) + ")");
}

Chunk SerialPort::read(std::uint8_t* buffer, std::size_t capacity, std::chrono::milliseconds timeout) {
  pollfd event = {descriptor_, POLLIN, 0};
  const int ready = poll(&event, 1, static_cast<int>(timeout.count()));
  if (ready < 0 && errno != EINTR) fail("cannot be waited for");
  if (ready <= 0) return {};
  const ssize_t size = ::read(descriptor_, buffer, capacity);
  if (size > 0) return {static_cast<std::size_t>(size), now_()};
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  if (size == 0) errno = EIO;  // ready but empty: the other end is gone
  fail("was unplugged or switched off");
}

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

std::string missing(const std::string& path) {
  const std::vector<std::string> ports = serialPortCandidates();
  return "there is no serial port " + path + ": " +
         (ports.empty()
              ? "plug the board in (no /dev/serial/by-id/*, /dev/ttyACM* or /dev/ttyUSB* is there either)"
              : "plug the board in, or set serial_port to one that is there: " + settings::joined(ports));
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
