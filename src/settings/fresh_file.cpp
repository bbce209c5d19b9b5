#include "settings/fresh_file.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "settings/file_kind.h"
#include "settings/replace_file.h"

namespace fsr::settings {

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
