#include "mesh/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "mesh/mesh_formats.h"
#include "settings/foreign_error.h"
#include "settings/regular_file.h"

namespace fsr::mesh {

namespace {

constexpr std::uint64_t kLargestFile = 1000000000;  // [bytes]
constexpr double kFarthest = 1e6;                   // from the origin [m]

using Reader = std::vector<Point> (*)(const std::string& bytes);

Reader readerOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (ending == ".stl") return stlCorners;
  if (ending == ".ply") return plyCorners;
  if (ending == ".obj") return objCorners;
  throw settings::InputError(path + ": ends with \"" + ending +
                             "\", but a mesh must be a .stl, .ply or .obj file");
}

void scale(std::vector<Point>& corners, double unit) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] *= unit;
    if (!corners[i].allFinite()) {
      throw settings::InputError("triangle " + std::to_string(i / 3) +
                                 " has a coordinate that is not a finite number");
    }
    if (corners[i].cwiseAbs().maxCoeff() > kFarthest) {
      throw settings::InputError("triangle " + std::to_string(i / 3) +
                                 " has a coordinate beyond 1000 km; check --units (mm, cm, m or inch)");
    }
  }
}

}  // namespace

void addPolygon(const std::vector<Point>& vertices, const std::vector<std::size_t>& polygon,
                std::vector<Point>& corners) {
  for (const std::size_t vertex : polygon) {
    if (vertex >= vertices.size()) {
      throw settings::InputError("has a face with the vertex " + std::to_string(vertex) +
                                 ", counted from 0, but only " + std::to_string(vertices.size()) +
                                 " vertices");
    }
  }
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    for (const std::size_t vertex : {polygon[0], polygon[i - 1], polygon[i]})
      corners.push_back(vertices[vertex]);
  }
}

Mesh readMesh(const std::string& path, double unit) {
  settings::RegularFile file(path, kLargestFile);
  const Reader read = readerOf(path);
  try {
    std::vector<Point> corners = read(file.rest());
    scale(corners, unit);
    Mesh mesh = weld(corners);
    if (mesh.triangles.empty()) throw settings::InputError("holds no triangles");
    return mesh;
  } catch (const std::exception& error) {
    throw settings::sentenceAbout(path, error);
  }
}

}  // namespace fsr::mesh
