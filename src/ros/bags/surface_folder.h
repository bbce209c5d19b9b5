#pragma once

#include <string>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr_ros {

/// A folder of surface files, by the names that users give: `cylinder_7cm` is cylinder_7cm.yaml in it; a
/// name with a slash is a path or URL of its own.
class SurfaceFolder {
 public:
  SurfaceFolder() = default;
  /// `folder`: path or URL; `size` checks files with one value for each taxel. Throws fsr::InputError.
  SurfaceFolder(const std::string& folder, fsr::matrix::MatrixSize size);

  /// The package's own folder, config/surfaces.
  static std::string shipped() { return "package://fsr_pressure_map/config/surfaces"; }

  /// The file of that name; throws fsr::InputError that lists the names where there is none.
  std::string pathOf(const std::string& surface) const;

  /// Reads it; throws fsr::InputError.
  fsr::matrix::Surface load(const std::string& surface) const;

 private:
  std::string folder_;
  fsr::matrix::MatrixSize size_;
};

}  // namespace fsr_ros
