#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace fsr::settings {

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
