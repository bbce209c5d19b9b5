#pragma once

#include <string>

#include "mesh/mesh_surface.h"

namespace fsr::mesh {

/// What a surface was made from, for the texts about it.
struct MeshOrigin {
  std::string mesh;  ///< file name without folders
  std::string path;  ///< of the mesh, relative to the surface file
  MeshUnit unit;
  Point at;             ///< as it was given, in the unit
  Point row_direction;  ///< as it was given
  std::size_t vertices = 0;
  std::size_t triangles = 0;
};

/// The surface file: `taxels` with curvature x, y, xy and deviation, a comment on where they come from, and
/// `mesh` with the place of the matrix (matrix/mesh_place.h).
std::string surfaceFileText(const MeshSurface& surface, const SheetPlace& place, const MeshOrigin& origin);

/// What a user needs to judge the surface: which side is up, convex or concave, the fit, the spread of
/// curvature and deviation, and whether the sheet would wrinkle.
std::string surfaceReport(const MeshSurface& surface, const SheetPlace& place, const MeshOrigin& origin);

}  // namespace fsr::mesh
