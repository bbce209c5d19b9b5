#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "matrix/surface_file.h"

namespace fsr_ros {

/// A folder of surface files. The name `cylinder_7cm` stands for cylinder_7cm.yaml in the folder; a name with
/// a slash is a path or URL.
class SurfaceFolder {
 public:
  SurfaceFolder() = default;
  /// `folder`: path or URL. `size`: files with one value for each taxel must fit it. Throws fsr::InputError.
  SurfaceFolder(const std::string& folder, fsr::matrix::MatrixSize size);

  /// The package's own folder, config/surfaces.
  static std::string shipped() { return "package://fsr_pressure_map/config/surfaces"; }

  /// The path of a surface file. Throws fsr::InputError that lists the surfaces in the folder if there is
  /// none of that name.
  std::string pathOf(const std::string& surface) const;

  /// Reads a surface file. Throws fsr::InputError.
  fsr::matrix::Surface load(const std::string& surface) const;
  /// The scan that a surface file was made from, if it names one. Throws fsr::InputError.
  std::optional<fsr::matrix::MeshPlace> meshOf(const std::string& surface) const;

 private:
  std::string folder_;
  fsr::matrix::MatrixSize size_;
};

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
