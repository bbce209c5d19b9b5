#include "settings/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "settings/file_kind.h"

namespace fsr::settings {

namespace fs = std::filesystem;

InputError cannotWrite(const std::string& path, int error) {
  return InputError(path + ": cannot be written (" + std::strerror(error) +
                    "); give a path in a directory that exists and may be written to");
}

void requireReplaceable(const std::string& path, const std::string& kind) {
  if (path.empty()) throw InputError("the name of a file to write is empty; give a path");
  struct stat found {};
  const bool exists = ::stat(path.c_str(), &found) == 0;
  if (!exists && errno != ENOENT) throw cannotWrite(path, errno);
  if (exists && S_ISDIR(found.st_mode)) throw cannotWrite(path, EISDIR);
  if (exists && !S_ISREG(found.st_mode)) {
    throw InputError(path +
                     ": is a device or a pipe, and only files are replaced; give the path of a new or an "
                     "existing file");
  }
  const std::string found_kind = exists && !kind.empty() ? kindOfFile(path) : "";
  if (!found_kind.empty() && found_kind != kind) {
    throw InputError(path + ": is " + found_kind + ", which is not replaced by " + kind +
                     "; give another name for the output");
  }
  const std::string parent = fs::path(path).parent_path().string();
  if (::access(parent.empty() ? "." : parent.c_str(), W_OK | X_OK) != 0) throw cannotWrite(path, errno);
}

std::string fullPath(const std::string& path) {
  return fs::absolute(path).lexically_normal().string();
}

bool sameFile(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  const fs::path full_a = fs::weakly_canonical(fs::absolute(a, error), error);
  if (error) return false;
  const fs::path full_b = fs::weakly_canonical(fs::absolute(b, error), error);
  return !error && full_a == full_b;
}

void requireNoInput(const std::string& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    if (!sameFile(output, input)) continue;
    throw InputError(output + ": would be overwritten, but is one of the inputs" +
                     (input == output ? "" : ", " + input) + "; give another name for the output");
  }
}

int renameToNew(const std::string& from, const std::string& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  // A file system that cannot do this, e.g. NFS: a second name is made, which fails where it exists.
  if (::link(from.c_str(), to.c_str()) != 0) return errno;
  return ::unlink(from.c_str()) == 0 ? 0 : errno;
}

}  // namespace fsr::settings
