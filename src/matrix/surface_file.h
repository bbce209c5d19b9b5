#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "settings/settings.h"

namespace fsr::matrix {

/// Position and orientation of one frame in another.
struct Pose {
  std::array<double, 3> position{0, 0, 0};       ///< [m]
  std::array<double, 4> quaternion{0, 0, 0, 1};  ///< x, y, z, w; length 1
};

/// The pose of the other frame in this one.
Pose inverse(const Pose& pose);

/// The matrix frame on a limb with the axis z: `around` from x about the axis [rad], `along` z from the
/// origin [m]. The surface's axis, the direction of its lesser curvature, is that of the limb. Its radius is
/// that of the taxel in the middle; 0.07 m where it is flat.
Pose onLimb(const Surface& surface, double around, double along);

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

/// Largest curvature of a surface: a radius of 10 mm.
constexpr double kMaxCurvature = 100.0;  // [1/m]

/// Reads a surface file (config/surfaces/*.yaml). Forms:
///
///     surface: cylinder_7cm          surface: saddle              surface: limb_7
///     cylinder:                      two_planes:                  taxels:
///       radius: 0.07    # [m]          x: 14.3    # [1/m]           x: [...]   # [1/m], row-major
///       axis: y         # x or y       y: -3.0                      y: [...]   # optional
///       side: outside   # or inside    xy: 0.0                      xy: [...]  # optional
///
/// or `flat: true`. A cylinder with its axis along y bends the rows (curvature x); `inside` makes the
/// curvature negative. `deviation` [1/m] is optional; `taxels` may have one for each taxel instead. `size`:
/// the number of values that a `taxels` form must have. Throws InputError. readSurface() ignores other keys
/// of the caller; readSurfaceFile() refuses them, except a sound section `mesh` (mesh_place.h).
Surface readSurface(const settings::Settings& settings, MatrixSize size);
/// Names of the surface files in a folder, sorted.
std::vector<std::string> surfacesIn(const std::string& folder);
/// Whether the settings contain one of these forms and not only a name.
bool hasSurfaceForm(const settings::Settings& settings);
Surface readSurfaceFile(const std::string& path, MatrixSize size);

}  // namespace fsr::matrix
