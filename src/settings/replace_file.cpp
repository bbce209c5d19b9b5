#include "settings/replace_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace fsr::settings {

namespace {

bool writeAll(int file, const std::string& content) {
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t now = ::write(file, content.data() + done, content.size() - done);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) return false;
    done += static_cast<std::size_t>(now);
  }
  return ::fsync(file) == 0;
}

// Returns 0 or an errno.
int writeFresh(const std::string& path, const std::string& content) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return errno;
  const int error = writeAll(file, content) ? 0 : errno;
  return ::close(file) != 0 && error == 0 ? errno : error;
}

}  // namespace

InputError cannotWrite(const std::string& path, int error) {
  return InputError(path + ": cannot be written (" + std::strerror(error) +
                    "); give a path in a directory that exists and may be written to");
}

void replaceFile(const std::string& path, const std::string& content) {
  const std::string fresh = path + ".new-" + std::to_string(::getpid());
  int error = writeFresh(fresh, content);
  if (error == 0 && std::rename(fresh.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(fresh.c_str());
  throw cannotWrite(path, error);
}

void requireReplaceable(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::absolute(path).parent_path();
  std::error_code ignored;
  if (path.empty() || std::filesystem::is_directory(path, ignored)) throw cannotWrite(path, EISDIR);
  if (::access(parent.c_str(), W_OK | X_OK) != 0) throw cannotWrite(path, errno);
}

}  // namespace fsr::settings
