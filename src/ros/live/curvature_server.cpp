#include "ros/live/curvature_server.h"

#include <filesystem>

#include "ros/live/parameters.h"
#include "ros/messages/surface_message.h"

namespace fsr_ros {

namespace fs = std::filesystem;

CurvatureServer::CurvatureServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
    : handle_(handle) {
  const Parameters parameters(private_handle);
  const fsr::settings::Range side{1, fsr::matrix::kMaxMatrixSide, ""};
  fsr::matrix::MatrixSize size;
  size.rows = static_cast<std::uint16_t>(parameters.integer("rows", 7, side));
  size.columns = static_cast<std::uint16_t>(parameters.integer("columns", 10, side));
  surfaces_ = SurfaceFolder(parameters.text("surfaces", SurfaceFolder::shipped()), size);
  frame_id_ = parameters.text("frame_id", "fsr_matrix");
  const std::string initial = parameters.text("surface", "");
  if (!initial.empty()) surface_ = surfaces_.load(initial);
  surface_.mount = static_cast<std::uint32_t>(parameters.integer("mount", 1, {0, 1e9, ""}));

  publisher_ = handle_.advertise<fsr_pressure_map::SurfaceCurvature>("curvature", 10, true);
  ros::NodeHandle services(private_handle);
  service_ = services.advertiseService("set_surface", &CurvatureServer::setSurface, this);
  timer_ = handle_.createTimer(ros::Duration(1.0), [this](const ros::TimerEvent&) { publish(); });
  publish();
}

bool CurvatureServer::setSurface(fsr_pressure_map::SetSurface::Request& request,
                                 fsr_pressure_map::SetSurface::Response& response) {
  try {
    fsr::matrix::Surface next = surfaces_.load(request.surface);
    next.mount = request.mount != 0 ? request.mount : surface_.mount + 1;
    surface_ = std::move(next);
    publish();
    response.success = true;
    response.message = "the matrix lies on " + surface_.name + " (mount " + std::to_string(surface_.mount) +
                       "), from " + fs::absolute(surfaces_.pathOf(request.surface)).string();
  } catch (const fsr::settings::InputError& error) {
    response.success = false;
    response.message = std::string(error.what()) + "; the surface is still " +
                       (surface_.known() ? surface_.name : "unknown");
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
