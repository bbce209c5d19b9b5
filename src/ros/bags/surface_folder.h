#pragma once

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

}  // namespace fsr_ros
