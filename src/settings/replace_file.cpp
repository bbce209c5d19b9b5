#include "settings/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "settings/regular_file.h"

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

namespace {

constexpr unsigned kBuffer = 1 << 18;  // [bytes]

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

FreshPath::FreshPath(const std::string& path, const std::string& kind)
    : path_(path), fresh_(path + ".new-" + std::to_string(::getpid())) {
  requireReplaceable(path, kind);
}

FreshPath::~FreshPath() {
  std::error_code ignored;
  if (!done_) std::filesystem::remove_all(fresh_, ignored);
}

void FreshPath::finish() {
  requireReplaceable(path_, kindOfFile(fresh_));  // again: the computation may have taken hours
  const int file = ::open(fresh_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw cannotWrite(path_, errno);
  const int error = ::fsync(file) == 0 ? 0 : errno;
  ::close(file);
  if (error != 0) throw cannotWrite(path_, error);
  if (std::rename(fresh_.c_str(), path_.c_str()) != 0) throw cannotWrite(path_, errno);
  done_ = true;
}

// zlib writes plain files too ("T"), so both use the same code.
struct FreshFile::Stream {
  explicit Stream(int descriptor, bool compressed)
      : file(descriptor), gz(::gzdopen(descriptor, compressed ? "wb6" : "wbT")) {
    if (gz != nullptr) ::gzbuffer(gz, kBuffer);
  }
  ~Stream() {
    if (gz != nullptr) ::gzclose(gz);
  }
  int file;
  gzFile gz;
};

FreshFile::FreshFile(const std::string& path, const std::string& kind)
    : path_(path), fresh_(path, endsWith(path, ".gz") ? file_kind::kCompressed : kind) {
  const int file = ::open(fresh_.name().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) refuse();
  stream_ = std::make_unique<Stream>(file, endsWith(path, ".gz"));
}

FreshFile::~FreshFile() = default;

void FreshFile::refuse() const {
  throw cannotWrite(path_, errno != 0 ? errno : EIO);
}

void FreshFile::write(const char* bytes, std::size_t size) {
  errno = 0;
  if (size > 0 && ::gzwrite(stream_->gz, bytes, static_cast<unsigned>(size)) == 0) refuse();
}

void FreshFile::patch(std::size_t offset, const std::string& text) {
  errno = 0;
  if (::gzflush(stream_->gz, Z_FINISH) != Z_OK) refuse();
  const ssize_t done = ::pwrite(stream_->file, text.data(), text.size(), static_cast<off_t>(offset));
  if (done != static_cast<ssize_t>(text.size())) refuse();
}

void FreshFile::finish() {
  errno = 0;
  gzFile gz = stream_->gz;
  stream_->gz = nullptr;
  if (::gzclose(gz) != Z_OK) refuse();
  fresh_.finish();
}

void replaceFile(const std::string& path, const std::string& content) {
  FreshFile file(path, kindOf(content));
  file.write(content);
  file.finish();
}

}  // namespace fsr::settings
