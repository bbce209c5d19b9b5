#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace test_support {

/// A new folder below /tmp. It is deleted with its content when this object is destroyed.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path(const std::string& name = "") const { return name.empty() ? path_ : path_ + "/" + name; }

 private:
  std::string path_;
};

/// The board's end of a serial line: a pseudo-terminal. The other end has a name that the test chooses.
/// Destroying the object unplugs the board.
class Pty {
 public:
  /// `link`: path of a symbolic link to the port, which is made.
  explicit Pty(const std::string& link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  /// Blocks while the line's buffer is full. Returns false if nobody reads it for a second.
  bool write(const std::vector<std::uint8_t>& bytes);
  /// Speed that the reader has set [1/s].
  unsigned speed() const;
  /// Whether a program has the port open.
  bool isOpen() const;

 private:
  std::string link_;
  int master_ = -1;
};

}  // namespace test_support
