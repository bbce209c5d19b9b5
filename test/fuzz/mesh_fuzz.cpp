// A mesh file gives a mesh whose numbers are finite and whose lists fit each other, or is refused with one
// sentence. On a mesh that is read, a sheet is laid: the surface has finite values, or is refused with one
// sentence, too.
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"
#include "mesh/mesh_file.h"
#include "mesh/mesh_surface.h"

namespace {

// Links to the input, because the kind of a mesh is told by the ending of its name.
class Links {
 public:
  Links() {
    std::string name = std::filesystem::temp_directory_path() / "mesh_fuzz_XXXXXX";
    if (mkdtemp(name.data()) == nullptr) std::abort();
    folder_ = name;
  }
  ~Links() { std::filesystem::remove_all(folder_); }
  Links(const Links&) = delete;
  Links& operator=(const Links&) = delete;

  std::string to(const std::string& path, const char* ending) const {
    const std::string link = folder_ + "/mesh" + ending;
    std::filesystem::remove(link);
    std::filesystem::create_symlink(path, link);
    return link;
  }

 private:
  std::string folder_;
};

void checkMesh(const fsr::mesh::Mesh& mesh) {
  fuzz::require(!mesh.triangles.empty() && std::isfinite(mesh.diameter()));
  fuzz::require(mesh.first.size() == mesh.vertices.size() + 1);
  fuzz::require(mesh.around.size() == 3 * mesh.triangles.size() && mesh.first.back() == mesh.around.size());
  for (const fsr::mesh::Point& vertex : mesh.vertices) fuzz::require(vertex.allFinite());
  for (const fsr::mesh::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) fuzz::require(vertex < mesh.vertices.size());
  }
}

// A sheet of 2 x 2 taxels in the middle of the first triangle.
void checkSurface(const fsr::mesh::Mesh& mesh) {
  const auto& [a, b, c] = mesh.triangles.front();
  fsr::mesh::SheetPlace place;
  place.layout = {{2, 2}, 0.001, 0.001};
  place.at = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
  place.row_direction = mesh.vertices[b] - mesh.vertices[a];
  place.radius = 0.003;
  const fsr::mesh::MeshSurface made = fsr::mesh::surfaceFromMesh(mesh, place, "fuzz");
  fuzz::require(made.surface.curvature.size() == 4 && made.surface.deviation.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const fsr::matrix::Curvature& curvature = made.surface.curvature[i];
    fuzz::require(std::isfinite(curvature.x) && std::isfinite(curvature.y) && std::isfinite(curvature.xy));
    fuzz::require(std::isfinite(made.surface.deviation[i]) && made.surface.deviation[i] >= 0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return -1;
  static const Links links;
  constexpr std::array<const char*, 3> kEndings = {".stl", ".ply", ".obj"};
  const fuzz::MemoryFile file(bytes + 1, size - 1);
  try {
    const fsr::mesh::Mesh mesh = fsr::mesh::readMesh(links.to(file.path(), kEndings[bytes[0] % 3]), 0.001);
    checkMesh(mesh);
    checkSurface(mesh);
  } catch (const fsr::settings::InputError&) {
  }
  return 0;
}
