#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "mesh/lay_sheet.h"
#include "mesh/mesh.h"

namespace fsr::mesh {

/// Unit of the coordinates in a mesh file: mm, cm, m or inch.
struct MeshUnit {
  std::string name;
  double length = 1;  ///< [m]
};

/// Throws InputError for another name.
MeshUnit meshUnit(const std::string& name);

/// Lowest, middle and highest of the values of all taxels.
struct Spread {
  double low = 0;
  double median = 0;
  double high = 0;
};

/// How the distance between neighbouring taxels of a column differs from the pitch. On a surface that bends
/// in one direction only (cylinder, cone) it does not; elsewhere a sheet that cannot stretch wrinkles.
struct PitchError {
  double largest = 0;   ///< error of largest magnitude, as a share of the pitch, with its sign
  std::size_t row = 0;  ///< of the lower row number of the two taxels
  std::size_t column = 0;
};

/// A wrinkling sheet is warned of from this error on.
constexpr double kLargestPitchError = 0.05;

/// The surface of a matrix on a mesh.
struct MeshSurface {
  LaidSheet sheet;
  matrix::Surface surface;        ///< of `sheet`, with one deviation for each taxel
  std::vector<double> strongest;  ///< principal curvature of largest magnitude of each taxel [1/m]
  std::vector<double> weakest;    ///< the other principal curvature [1/m]
  PitchError pitch_error;
};

/// Lays a matrix on a mesh and takes the curvature of each taxel from it. The deviation of a taxel is the
/// standard deviation of its principal curvature of largest magnitude, from the mesh's roughness (covariance
/// of the fit), together with LaidSheet::bias. Throws InputError as laySheet() does, and where the mesh is
/// smaller than the sheet, so large that its unit must be wrong, or bent more sharply than
/// matrix::kMaxCurvature.
MeshSurface surfaceFromMesh(const Mesh& mesh, const SheetPlace& place, const std::string& name);

Spread spread(std::vector<double> values);

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
