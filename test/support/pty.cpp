#include "support/pty.h"

#include <asm/termbits.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace test_support {
namespace {

// The slave is closed again at once, so that only the program under test opens it and its closing is visible.
std::string unlock(int master) {
  char name[64] = "";
  if (grantpt(master) != 0 || unlockpt(master) != 0 || ptsname_r(master, name, sizeof(name)) != 0) {
    throw std::runtime_error("no pseudo-terminal");
  }
  return name;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  char name[] = "/tmp/test_support_XXXXXX";
  if (mkdtemp(name) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Pty::Pty(const std::string& link) : link_(link), master_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
  if (master_ < 0) throw std::runtime_error("no pseudo-terminal");
  const std::string slave = unlock(master_);
  std::filesystem::remove(link);
  std::filesystem::create_symlink(slave, link);
}

Pty::~Pty() {
  std::error_code ignored;
  std::filesystem::remove(link_, ignored);
  close(master_);
}

bool Pty::write(const std::vector<std::uint8_t>& bytes) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    pollfd event = {master_, POLLOUT, 0};
    if (poll(&event, 1, 1000) <= 0) return false;
    const ssize_t size = ::write(master_, bytes.data() + written, bytes.size() - written);
    if (size < 0) return false;
    written += static_cast<std::size_t>(size);
  }
  return true;
}

unsigned Pty::speed() const {
  termios2 settings{};
  return ioctl(master_, TCGETS2, &settings) == 0 ? settings.c_ospeed : 0;
}

// The kernel reports a hang-up on the master after the last slave was closed.
bool Pty::isOpen() const {
  pollfd event = {master_, POLLIN, 0};
  return poll(&event, 1, 0) >= 0 && (event.revents & POLLHUP) == 0;
}

}  // namespace test_support
