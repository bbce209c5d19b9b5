#pragma once

#include <string>

namespace fsr::conductor {

/// Makes the folder of a session that of one conductor. The lock ends with the process that holds it, however
/// that ends.
class FolderLock {
 public:
  /// Throws InputError where another process holds it. A file system that has no locks is no hindrance.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace fsr::conductor
