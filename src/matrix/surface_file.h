#pragma once

#include <string>

#include "fsr_pressure_map/matrix/curvature.h"
#include "settings/settings.h"

namespace fsr::matrix {

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
/// Whether the settings contain one of these forms and not only a name.
bool hasSurfaceForm(const settings::Settings& settings);
Surface readSurfaceFile(const std::string& path, MatrixSize size);

}  // namespace fsr::matrix
