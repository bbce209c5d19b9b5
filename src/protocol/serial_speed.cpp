// Separate from serial_port.cpp, because the kernel's termios and the C library's cannot be in the same file.
#include <asm/termbits.h>
#include <sys/ioctl.h>

#include <cerrno>
#include <cstdint>

namespace fsr::protocol {

// BOTHER accepts any rate; the kernel returns the rate that the hardware really uses.
bool setUnnamedSpeed(int descriptor, std::uint32_t baud) {
  termios2 settings{};
  if (ioctl(descriptor, TCGETS2, &settings) != 0) return false;
  settings.c_cflag &= ~static_cast<tcflag_t>(CBAUD | (CBAUD << IBSHIFT));
  settings.c_cflag |= BOTHER | (BOTHER << IBSHIFT);
  settings.c_ispeed = baud;
  settings.c_ospeed = baud;
  if (ioctl(descriptor, TCSETS2, &settings) != 0 || ioctl(descriptor, TCGETS2, &settings) != 0) return false;
  // A UART tolerates about 2 % before bytes come out wrong.
  const std::int64_t made = settings.c_ospeed;
  const bool close_enough = made * 100 >= std::int64_t{baud} * 97 && made * 100 <= std::int64_t{baud} * 103;
  if (!close_enough) errno = EINVAL;
  return close_enough;
}

// The speed that is set [1/s]; 0 = unknown.
std::uint32_t speedOf(int descriptor) {
  termios2 settings{};
  return ioctl(descriptor, TCGETS2, &settings) == 0 ? settings.c_ospeed : 0;
}

}  // namespace fsr::protocol
