#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fsr_ros {

/// What the matrix lies on, as the user named it.
struct LaidOn {
  std::string surface;  ///< name or path of a surface file; empty = unknown
  std::uint32_t mount = 0;

  bool operator==(const LaidOn& other) const { return surface == other.surface && mount == other.mount; }
  bool operator!=(const LaidOn& other) const { return !(*this == other); }
  /// "cylinder_7cm, mount 2".
  std::string text() const;
};

/// Keeps the last surface and mount in a file, so that a node that died goes on with them instead of with
/// those of its launch file.
class SurfaceMemory {
 public:
  /// `launched`: what the launch file says. If the file cannot be read, remark() says so.
  SurfaceMemory(std::string path, const LaidOn& launched);

  /// What the matrix lies on: what the last run was told, if it died and had been launched with the same
  /// surface and mount; otherwise what the launch file says.
  const LaidOn& start() const { return start_; }
  /// A sentence for the log if the last run was told something else than the launch file says; empty
  /// otherwise.
  const std::string& remark() const { return remark_; }

  /// Stores what ~set_surface says. Throws fsr::InputError if the file cannot be written, or
  /// is there and no such memory.
  void keep(const LaidOn& now);
  /// Notes that the node was stopped, so that the next run takes what its launch file says.
  void end();

 private:
  struct Stored {
    LaidOn launched, now;
    bool ended = false;
  };

  static Stored load(const std::string& path);
  void save();

  std::string path_;
  std::optional<Stored> stored_;
  LaidOn launched_;
  LaidOn start_;
  std::string remark_;
};

}  // namespace fsr_ros
