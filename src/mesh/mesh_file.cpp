#include "mesh/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/foreign_error.h"
#include "settings/regular_file.h"

namespace fsr::mesh {

namespace {

constexpr std::uint64_t kLargestFile = 1000000000;  // [bytes]

void requireKnownKind(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (ending != ".stl" && ending != ".ply" && ending != ".obj") {
    throw settings::InputError(path + ": ends with \"" + ending +
                               "\", but a mesh must be a .stl, .ply or .obj file");
  }
}

void addTriangles(const aiMesh& part, double unit, std::vector<Point>& corners) {
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    for (unsigned k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= part.mNumVertices)
        throw settings::InputError("triangle " + std::to_string(i) + " names vertex " +
                                   std::to_string(face.mIndices[k]) + ", but there are " +
                                   std::to_string(part.mNumVertices));
      const aiVector3D& vertex = part.mVertices[face.mIndices[k]];
      if (!std::isfinite(vertex.x) || !std::isfinite(vertex.y) || !std::isfinite(vertex.z)) {
        throw settings::InputError("triangle " + std::to_string(i) +
                                   " has a coordinate that is not a finite number");
      }
      corners.push_back(unit * Point(vertex.x, vertex.y, vertex.z));
    }
  }
}

std::vector<Point> cornersIn(const std::string& path, double unit) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr) {
    const std::string reason = importer.GetErrorString();
    throw settings::InputError("cannot be read as a mesh" + (reason.empty() ? "" : " (" + reason + ")"));
  }
  std::vector<Point> corners;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) addTriangles(*scene->mMeshes[i], unit, corners);
  return corners;
}

}  // namespace

Mesh readMesh(const std::string& path, double unit) {
  settings::requireRegularFile(path, kLargestFile);
  requireKnownKind(path);
  try {
    Mesh mesh = weld(cornersIn(path, unit));
    if (mesh.triangles.empty()) throw settings::InputError("holds no triangles");
    return mesh;
  } catch (const std::exception& error) {
    throw settings::sentenceAbout(path, error);
  }
}

}  // namespace fsr::mesh
