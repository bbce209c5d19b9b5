#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.h"

namespace fsr::mesh {

// Readers of one format each: the corners of the triangles, three each, in the unit of the file. Polygons are
// cut into triangles that share their first corner. They throw InputError, without the name of the file.
// Coordinates may be nan or inf. Time and memory are proportional to the length of the file, whatever numbers
// it states.

std::vector<Point> stlCorners(const std::string& bytes);  ///< text, or binary
std::vector<Point> objCorners(const std::string& bytes);  ///< v and f; everything else is ignored
std::vector<Point> plyCorners(const std::string& bytes);  ///< text, or binary of either byte order

/// Adds a polygon of vertices to the corners. Throws InputError for an index beyond the vertices.
void addPolygon(const std::vector<Point>& vertices, const std::vector<std::size_t>& polygon,
                std::vector<Point>& corners);

}  // namespace fsr::mesh
