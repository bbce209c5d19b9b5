#include "fsr_pressure_map/ros/surface_folder.h"

#include <filesystem>

#include "fsr_pressure_map/matrix/surface_file.h"
#include "fsr_pressure_map/ros/resource_path.h"

namespace fsr_ros {

namespace fs = std::filesystem;

namespace {

std::string namesIn(const std::string& folder) {
  std::string names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml")
      names += (names.empty() ? "" : ", ") + entry.path().stem().string();
  }
  return names.empty() ? "none" : names;
}

}  // namespace

SurfaceFolder::SurfaceFolder(const std::string& folder, fsr::MatrixSize size)
    : folder_(resolveResource(folder)), size_(size) {}

std::string SurfaceFolder::pathOf(const std::string& surface) const {
  const bool is_path = surface.find('/') != std::string::npos;
  std::string path =
      is_path ? resolveResource(surface) : (fs::path(folder_) / (surface + ".yaml")).string();
  if (!fs::exists(path)) {
    throw fsr::InputError("surface " + surface + ": there is no file " + path + "; surfaces in " + folder_ +
                          ": " + namesIn(folder_));
  }
  return path;
}

fsr::Surface SurfaceFolder::load(const std::string& surface) const {
  return fsr::readSurfaceFile(pathOf(surface), size_);
}

}  // namespace fsr_ros
