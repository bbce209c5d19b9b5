#pragma once

#include <array>
#include <optional>
#include <string>

#include "settings/settings.h"

namespace fsr::matrix {

/// Position and orientation of one frame in another.
struct Pose {
  std::array<double, 3> position{0, 0, 0};       ///< [m]
  std::array<double, 4> quaternion{0, 0, 0, 1};  ///< x, y, z, w; length 1
};

/// The pose of the other frame in this one.
Pose inverse(const Pose& pose);

/// The scan or drawing that a surface was made from, and where the matrix lies on it.
struct MeshPlace {
  std::string file;  ///< absolute path
  double unit = 1;   ///< length of the mesh's unit [m]
  Pose matrix;       ///< the matrix frame in the frame of the mesh
};

/// Reads the section `mesh` of a surface file, which surface_from_mesh writes; nothing without one:
///
///     mesh:
///       file: socket.stl          # relative to the surface file
///       unit: 0.001               # [m]
///       middle: [0.05, 0, 0.12]   # of the matrix, in the mesh's frame [m]
///       row: [0, 1, 0]            # direction of the rows there
///       normal: [1, 0, 0]         # out of the loaded face
///
/// Throws InputError, also where row and normal are no perpendicular directions. Other keys are ignored.
std::optional<MeshPlace> readMeshPlace(const settings::Settings& settings);
/// Of a surface file, which must be one that readSurfaceFile() accepts.
std::optional<MeshPlace> readMeshPlaceFile(const std::string& path);

}  // namespace fsr::matrix
