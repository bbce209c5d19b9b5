#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::settings {

/// Writes `content` to a temporary file beside `path`, syncs it to the disk and renames it. At `path` there
/// is either the old or the complete new file, even where the program is killed. Throws InputError, which
/// names the path and the cause, and removes the temporary file; also where requireReplaceable() refuses the
/// path for this content.
void replaceFile(const std::string& path, const std::string& content);

/// Throws the InputError of replaceFile() where the directory or the permission to write is missing, and
/// where there is something else than a file at `path`: a directory, a device or a pipe is never replaced.
/// Nor is a file of another kind than `kind`, which is what will be written, as kindOf() calls it; empty =
/// not known yet. Call it before a long computation.
void requireReplaceable(const std::string& path, const std::string& kind = "");

/// The path from the root, as messages show it.
std::string fullPath(const std::string& path);

/// Whether two names, however they are spelled, stand for the same file. It need not exist.
bool sameFile(const std::string& a, const std::string& b);

/// Throws InputError where writing to `output` would destroy one of the `inputs`.
void requireNoInput(const std::string& output, const std::vector<std::string>& inputs);

/// Renames a file unless something has the name `to`. Returns 0, or an errno: EEXIST.
int renameToNew(const std::string& from, const std::string& to);

/// The InputError that both throw; `error` is an errno.
InputError cannotWrite(const std::string& path, int error);

/// A temporary name beside `path`, for a file or folder that the caller fills. At `path` there is either the
/// old or the complete new one, even where the program is killed. Throws InputError like replaceFile().
class FreshPath {
 public:
  /// Throws InputError, like requireReplaceable(), where nothing could be written, and where a file of
  /// another `kind` is at the path; empty = only finish() can tell.
  explicit FreshPath(const std::string& path, const std::string& kind = "");
  /// Removes the temporary file or folder unless finish() was called.
  ~FreshPath();
  FreshPath(const FreshPath&) = delete;
  FreshPath& operator=(const FreshPath&) = delete;

  const std::string& name() const { return fresh_; }
  /// Writes the content to the disk and renames it to `path`. Throws InputError where a file of another kind
  /// is there.
  void finish();

 private:
  std::string path_;
  std::string fresh_;
  bool done_ = false;
};

/// A file that is written piece by piece and appears complete or not at all. A path that ends with .gz is
/// compressed. Throws InputError like replaceFile(), also where the disk is full.
class FreshFile {
 public:
  /// `kind`: of what is written, before it is compressed.
  explicit FreshFile(const std::string& path, const std::string& kind = "");
  ~FreshFile();

  void write(const char* bytes, std::size_t size);
  void write(const std::string& text) { write(text.data(), text.size()); }
  /// Overwrites the bytes at `offset` [bytes]; not possible for .gz.
  void patch(std::size_t offset, const std::string& text);
  void finish();

 private:
  struct Stream;
  [[noreturn]] void refuse() const;

  std::string path_;
  FreshPath fresh_;
  std::unique_ptr<Stream> stream_;
};

}  // namespace fsr::settings
