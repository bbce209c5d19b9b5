#include "dataset/unnamed_file.h"

#include <fcntl.h>
#include <unistd.h>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::dataset {

namespace {

// Not /tmp, which may be memory.
std::string temporaryFolder() {
  const char* const folder = std::getenv("TMPDIR");
  return folder != nullptr && *folder != '\0' ? folder : "/var/tmp";
}

[[noreturn]] void refuse(const std::string& what) {
  throw settings::InputError(temporaryFolder() + ": data of long recordings cannot be " + what + " (" +
                             std::strerror(errno) +
                             "); set TMPDIR to a folder with room for four times the size of all bags");
}

int openUnnamed() {
  std::string name = temporaryFolder() + "/fsr_rows_XXXXXX";
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) refuse("kept there");
  ::unlink(name.c_str());
  return file;
}

}  // namespace

UnnamedFile::UnnamedFile() : file_(openUnnamed()) {}

UnnamedFile::~UnnamedFile() {
  ::close(file_);
}

void UnnamedFile::append(const void* bytes, std::size_t size) {
  for (const char* next = static_cast<const char*>(bytes); size > 0;) {
    const ssize_t written = ::write(file_, next, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) refuse("written");
    next += written;
    size -= static_cast<std::size_t>(written);
  }
}

void UnnamedFile::read(void* bytes, std::size_t size, std::size_t offset) const {
  for (char* next = static_cast<char*>(bytes); size > 0;) {
    const ssize_t got = ::pread(file_, next, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) refuse("read again");
    next += got;
    offset += static_cast<std::size_t>(got);
    size -= static_cast<std::size_t>(got);
  }
}

}  // namespace fsr::dataset
