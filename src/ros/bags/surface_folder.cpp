#include "ros/bags/surface_folder.h"

#include <algorithm>
#include <filesystem>

#include "matrix/surface_file.h"
#include "ros/bags/resource_path.h"
#include "settings/joined.h"

namespace fsr_ros {

namespace fs = std::filesystem;

SurfaceFolder::SurfaceFolder(const std::string& folder, fsr::matrix::MatrixSize size)
    : folder_(resolveResource(folder)), size_(size) {}

std::vector<std::string> SurfaceFolder::names() const {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string SurfaceFolder::pathOf(const std::string& surface) const {
  const bool is_path = surface.find('/') != std::string::npos;
  std::string path = is_path ? resolveResource(surface) : (fs::path(folder_) / (surface + ".yaml")).string();
  std::error_code error;
  if (!fs::exists(path, error)) {
    const std::string why = error ? " (" + error.message() + ")" : "", known = fsr::settings::joined(names());
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
