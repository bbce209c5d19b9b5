// Separate from pseudo_terminal.cpp, because the kernel's termios, which supports every rate and not only the
// named ones, and the C library's cannot be in the same file.
#include <asm/termbits.h>
#include <sys/ioctl.h>

#include <cstdint>

namespace fsr::emulator {

void setTerminalSpeed(int descriptor, std::uint32_t baud) {
  termios2 settings{};
  if (ioctl(descriptor, TCGETS2, &settings) != 0) return;
  settings.c_cflag &= ~static_cast<tcflag_t>(CBAUD | (CBAUD << IBSHIFT));
  settings.c_cflag |= BOTHER | (BOTHER << IBSHIFT);
  settings.c_ispeed = baud;
  settings.c_ospeed = baud;
  ioctl(descriptor, TCSETS2, &settings);
}

std::uint32_t terminalSpeed(int descriptor) {
  termios2 settings{};
  return ioctl(descriptor, TCGETS2, &settings) == 0 ? settings.c_ospeed : 0;
}

}  // namespace fsr::emulator
