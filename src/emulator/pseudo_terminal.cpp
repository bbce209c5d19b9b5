#include "emulator/pseudo_terminal.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::protocol {
// Defined in serial_speed.cpp.
bool setUnnamedSpeed(int descriptor, std::uint32_t baud);
std::uint32_t speedOf(int descriptor);
}  // namespace fsr::protocol

namespace fsr::emulator {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what) {
  throw settings::InputError("no pseudo-terminal: " + what + ": " + std::strerror(errno) +
                             "; is /dev/pts mounted?");
}

int openMaster() {
  const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master < 0) fail("/dev/ptmx cannot be opened");
  return master;
}

std::string unlockSlave(int master) {
  char name[64] = "";
  if (grantpt(master) != 0 || unlockpt(master) != 0 || ptsname_r(master, name, sizeof(name)) != 0) {
    fail("its port cannot be made");
  }
  return name;
}

// Sets raw mode before a reader opens the port, because the terminal would otherwise echo and translate
// bytes. The settings remain when the port is closed again, and closing it makes the kernel report whether a
// reader has it open.
void makeRaw(const std::string& slave, std::uint32_t baud) {
  const int descriptor = open(slave.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) fail(slave + " cannot be opened");
  termios settings{};
  tcgetattr(descriptor, &settings);
  cfmakeraw(&settings);
  tcsetattr(descriptor, TCSANOW, &settings);
  protocol::setUnnamedSpeed(descriptor, baud);
  close(descriptor);
}

// Creates the link under another name and renames it, so that it is never missing or dangling.
void makeLink(const std::string& link, const std::string& target) {
  std::error_code error;
  const fs::file_status there = fs::symlink_status(link, error);
  if (fs::exists(there) && !fs::is_symlink(there)) {
    throw settings::InputError(
        link + ": something other than a link is there already; name a free path for the port");
  }
  const std::string fresh = link + ".new";
  fs::remove(fresh, error);
  fs::create_symlink(target, fresh, error);
  if (!error) fs::rename(fresh, link, error);
  if (error) throw settings::InputError(link + ": the link to the port cannot be made: " + error.message());
}

}  // namespace

PseudoTerminal::PseudoTerminal(const std::string& link, std::uint32_t baud)
    : link_(link), master_(openMaster()) {
  try {
    slave_ = unlockSlave(master_);
    makeRaw(slave_, baud);
    if (!link_.empty()) makeLink(link_, slave_);
  } catch (...) {
    close(master_);
    throw;
  }
}

PseudoTerminal::~PseudoTerminal() {
  std::error_code ignored;
  // Only if it still points to this port: another emulator may use the name now.
  if (!link_.empty() && fs::read_symlink(link_, ignored) == slave_) fs::remove(link_, ignored);
  close(master_);
}

PseudoTerminal::Outcome PseudoTerminal::write(const std::uint8_t* packet, std::size_t size) {
  if (!hasReader()) return Outcome::kUnheard;
  if (!flushRest()) return Outcome::kFull;
  const ssize_t written = ::write(master_, packet, size);
  if (written <= 0) return Outcome::kFull;
  rest_.assign(packet + written, packet + size);  // the rest is sent before the next packet
  return Outcome::kSent;
}

bool PseudoTerminal::flushRest() {
  if (rest_.empty()) return true;
  const ssize_t written = ::write(master_, rest_.data(), rest_.size());
  if (written > 0) rest_.erase(rest_.begin(), rest_.begin() + written);
  return rest_.empty();
}

bool PseudoTerminal::waitForRoom(std::chrono::milliseconds timeout) {
  pollfd event = {master_, POLLOUT, 0};
  return poll(&event, 1, static_cast<int>(timeout.count())) > 0 && (event.revents & POLLOUT) != 0;
}

bool PseudoTerminal::hasReader() {
  pollfd event = {master_, POLLIN, 0};
  poll(&event, 1, 0);
  const bool has_reader = (event.revents & POLLHUP) == 0;
  if (has_reader && (event.revents & POLLIN) != 0) discardInput();
  if (had_reader_ && !has_reader) discardUnread();
  had_reader_ = has_reader;
  return has_reader;
}

// The board takes no commands. Without this, a reader that writes would fill the line and block.
void PseudoTerminal::discardInput() {
  char bytes[256];
  while (::read(master_, bytes, sizeof(bytes)) == static_cast<ssize_t>(sizeof(bytes))) {
  }
}

void PseudoTerminal::discardUnread() {
  rest_.clear();
  const int descriptor = open(slave_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  tcflush(descriptor, TCIFLUSH);
  close(descriptor);
}

std::uint32_t PseudoTerminal::readerBaud() const {
  return protocol::speedOf(master_);
}

}  // namespace fsr::emulator
