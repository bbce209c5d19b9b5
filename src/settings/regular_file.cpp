#include "settings/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace fsr::settings {

namespace {

// "16 MiB", or bytes where it is less than one.
std::string sizeText(std::uint64_t bytes) {
  return bytes >> 20 > 0 ? std::to_string(bytes >> 20) + " MiB" : std::to_string(bytes) + " bytes";
}

InputError unreadable(const std::string& path, int error) {
  if (error == ENOENT) return InputError(path + ": there is no such file");
  return InputError(path + ": cannot be opened (" + std::strerror(error) +
                    "); give the path of a file that may be read");
}

}  // namespace

RegularFile::RegularFile(const std::string& path, std::uint64_t largest)
    : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {
  if (descriptor_ < 0) throw unreadable(path, errno);
  struct stat found {};
  const int error = ::fstat(descriptor_, &found) == 0 ? 0 : errno;
  size_ = static_cast<std::uint64_t>(found.st_size);
  if (error == 0 && S_ISREG(found.st_mode) && size_ <= largest) return;
  ::close(descriptor_);
  if (error != 0) throw unreadable(path, error);
  if (S_ISDIR(found.st_mode)) throw InputError(path + ": is a folder; give the path of a file");
  if (!S_ISREG(found.st_mode)) throw InputError(path + ": is a device or a pipe; give the path of a file");
  throw InputError(path + ": has " + sizeText(size_) + ", but a file of this kind has " + sizeText(largest) +
                   " at most; is it the right file?");
}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::size_t RegularFile::read(void* bytes, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t now = ::read(descriptor_, static_cast<char*>(bytes) + done, size - done);
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) throw InputError(path_ + ": cannot be read (" + std::strerror(errno) + ")");
    if (now == 0) break;
    done += static_cast<std::size_t>(now);
  }
  return done;
}

std::string RegularFile::rest() {
  std::string bytes(size_, '\0');
  bytes.resize(read(bytes.data(), bytes.size()));
  return bytes;
}

int RegularFile::release() {
  return std::exchange(descriptor_, -1);
}

void requireRegularFile(const std::string& path, std::uint64_t largest) {
  const RegularFile throws_if_not(path, largest);
}

}  // namespace fsr::settings
