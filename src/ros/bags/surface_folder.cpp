#include "ros/bags/surface_folder.h"

#include <filesystem>

#include "matrix/surface_file.h"
#include "ros/bags/resource_path.h"
#include "settings/joined.h"

namespace fsr_ros {

namespace fs = std::filesystem;

SurfaceFolder::SurfaceFolder(const std::string& folder, fsr::matrix::MatrixSize size)
    : folder_(resolveResource(folder)), size_(size) {}

std::string SurfaceFolder::pathOf(const std::string& surface) const {
  const bool is_path = surface.find('/') != std::string::npos;
  std::string path = is_path ? resolveResource(surface) : (fs::path(folder_) / (surface + ".yaml")).string();
  std::error_code error;
  if (!fs::exists(path, error)) {
    const std::string why = error ? " (" + error.message() + ")" : "",
                      known = fsr::settings::joined(fsr::matrix::surfacesIn(folder_));
    throw fsr::settings::InputError("surface " + surface + ": there is no file " + path + why +
                                    "; surfaces in " + folder_ + ": " + (known.empty() ? "none" : known));
  }
  return path;
}

fsr::matrix::Surface SurfaceFolder::load(const std::string& surface) const {
  return fsr::matrix::readSurfaceFile(pathOf(surface), size_);
}

std::optional<fsr::matrix::MeshPlace> SurfaceFolder::meshOf(const std::string& surface) const {
  return fsr::matrix::readMeshPlaceFile(pathOf(surface));
}

}  // namespace fsr_ros
