#pragma once

#include <string>

#include "mesh/mesh.h"

namespace fsr::mesh {

/// Reads the triangles of an STL, PLY or OBJ file, text or binary. Polygons are cut into triangles that share
/// a corner.
/// `unit`: length of the file's unit [m]. Throws InputError where the file cannot be read, is of another
/// kind, or holds no triangle or a coordinate that is not a finite number.
Mesh readMesh(const std::string& path, double unit);

}  // namespace fsr::mesh
