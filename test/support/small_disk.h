#pragma once

#include <sys/mount.h>

#include <string>

#include "support/pty.h"

namespace test_support {

/// A small file system, mounted while this object exists. `size` is as for mount, e.g. "64k". Only root may
/// mount: ready() is false if the system forbids it; then a test should skip.
class SmallDisk {
 public:
  explicit SmallDisk(const std::string& size)
      : ready_(mount("none", folder_.path("").c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0) {}
  ~SmallDisk() {
    if (ready_) umount2(folder_.path("").c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool ready() const { return ready_; }
  void resize(const std::string& size) {
    mount("none", folder_.path("").c_str(), "tmpfs", MS_REMOUNT, ("size=" + size).c_str());
  }
  std::string path(const std::string& name) const { return folder_.path(name); }

 private:
  TemporaryFolder folder_;
  bool ready_;
};

}  // namespace test_support
