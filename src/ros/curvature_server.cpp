#include "fsr_pressure_map/ros/curvature_server.h"

#include <filesystem>

#include "fsr_pressure_map/matrix/surface_file.h"
#include "fsr_pressure_map/ros/parameters.h"
#include "fsr_pressure_map/ros/resource_path.h"
#include "fsr_pressure_map/ros/surface_message.h"

namespace fsr_ros {

namespace fs = std::filesystem;

namespace {

std::string shippedSurfaces() {
  return "package://fsr_pressure_map/config/surfaces";
}

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

CurvatureServer::CurvatureServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
    : handle_(handle) {
  const Parameters parameters(private_handle);
  const fsr::Range side{1, fsr::kMaxMatrixSide, ""};
  size_.rows = static_cast<std::uint16_t>(parameters.integer("rows", 7, side));
  size_.columns = static_cast<std::uint16_t>(parameters.integer("columns", 10, side));
  folder_ = resolveResource(parameters.text("surfaces", shippedSurfaces()));
  frame_id_ = parameters.text("frame_id", "fsr_matrix");
  const std::string initial = parameters.text("surface", "");
  if (!initial.empty()) surface_ = load(initial);
  surface_.mount = static_cast<std::uint32_t>(parameters.integer("mount", 1, {0, 1e9, ""}));

  publisher_ = handle_.advertise<fsr_pressure_map::SurfaceCurvature>("curvature", 10, true);
  ros::NodeHandle services(private_handle);
  service_ = services.advertiseService("set_surface", &CurvatureServer::setSurface, this);
  timer_ = handle_.createTimer(ros::Duration(1.0), [this](const ros::TimerEvent&) { publish(); });
  publish();
}

std::string CurvatureServer::pathOf(const std::string& surface) const {
  const bool is_path = surface.find('/') != std::string::npos;
  const std::string path =
      is_path ? resolveResource(surface) : (fs::path(folder_) / (surface + ".yaml")).string();
  if (!fs::exists(path)) {
    throw fsr::InputError("surface " + surface + ": there is no file " + path + "; surfaces in " + folder_ +
                          ": " + namesIn(folder_));
  }
  return path;
}

fsr::Surface CurvatureServer::load(const std::string& surface) const {
  return fsr::readSurfaceFile(pathOf(surface), size_);
}

bool CurvatureServer::setSurface(fsr_pressure_map::SetSurface::Request& request,
                                 fsr_pressure_map::SetSurface::Response& response) {
  try {
    fsr::Surface next = load(request.surface);
    next.mount = request.mount != 0 ? request.mount : surface_.mount + 1;
    surface_ = std::move(next);
    publish();
    response.success = true;
    response.message = "the matrix lies on " + surface_.name + " (mount " + std::to_string(surface_.mount) +
                       "), from " + fs::absolute(pathOf(request.surface)).string();
  } catch (const fsr::InputError& error) {
    response.success = false;
    response.message =
        std::string(error.what()) + "; still " + (surface_.known() ? surface_.name : "unknown");
  }
  return true;
}

void CurvatureServer::publish() {
  fsr_pressure_map::SurfaceCurvature message = toMessage(surface_);
  message.header.stamp = ros::Time::now();
  message.header.frame_id = frame_id_;
  publisher_.publish(message);
}

}  // namespace fsr_ros
