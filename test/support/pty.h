#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace test_support {

/// A new folder under /tmp that vanishes with its content.
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

/// The board's end of a serial line: a pseudo-terminal whose other end has a name of the test's choice.
/// Its destruction is the unplugging.
class Pty {
 public:
  /// `link`: a symbolic link that is made to the port.
  explicit Pty(const std::string& link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  /// Blocks where the line's buffer is full; false where nobody reads it for a second.
  bool write(const std::vector<std::uint8_t>& bytes);
  /// Speed that the reader has set [1/s].
  unsigned speed() const;
  /// True while somebody has the port open.
  bool isOpen() const;

 private:
  std::string link_;
  int master_ = -1;
};

}  // namespace test_support
