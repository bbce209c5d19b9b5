#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace fsr::settings {

/// A temporary name beside `path`, for a file or folder that somebody else fills: at `path` there is the old
/// one or the whole new one, whatever stops the program. Throws InputError, in the words of replaceFile().
class FreshPath {
 public:
  /// Refuses, as requireReplaceable() does, where nothing could be written.
  explicit FreshPath(const std::string& path);
  /// Without finish() nothing remains.
  ~FreshPath();
  FreshPath(const FreshPath&) = delete;
  FreshPath& operator=(const FreshPath&) = delete;

  const std::string& name() const { return fresh_; }
  /// Syncs what is there to the disk and gives it its name.
  void finish();

 private:
  std::string path_;
  std::string fresh_;
  bool done_ = false;
};

/// A file that is written piece by piece and appears whole or not at all. A path that ends with .gz is
/// written compressed. Throws InputError likewise: also where the disk is full.
class FreshFile {
 public:
  explicit FreshFile(const std::string& path);
  ~FreshFile();

  void write(const char* bytes, std::size_t size);
  void write(const std::string& text) { write(text.data(), text.size()); }
  /// Replaces what was written at `offset` [bytes]; not for .gz.
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
