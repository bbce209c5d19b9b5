#pragma once

#include <cstddef>

namespace fsr::dataset {

/// A temporary file without a name, for what of long recordings is too much for the memory. It lies in
/// TMPDIR (else /var/tmp) and is gone with the object or the process.
class UnnamedFile {
 public:
  /// All members throw InputError where the folder cannot be written or the disk is full.
  UnnamedFile();
  ~UnnamedFile();
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;

  void append(const void* bytes, std::size_t size);
  /// From any thread. There must be `size` bytes at `offset`.
  void read(void* bytes, std::size_t size, std::size_t offset) const;

 private:
  int file_;
};

}  // namespace fsr::dataset
