#include "protocol/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
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

}  // namespace fsr::protocol
