#pragma once

#include <fsr_pressure_map/SetSurface.h>
#include <ros/node_handle.h>

#include <string>

#include "fsr_pressure_map/matrix/curvature.h"
#include "ros/bags/surface_folder.h"

namespace fsr_ros {

/// Publishes what the matrix lies on: `curvature`, latched and repeated each second of ROS time, so
/// that a bag cut anywhere still knows its surface. Service `~set_surface` changes it while running.
///
/// Parameters: `~surface` (name of a file in `~surfaces`, or a path to a surface file; empty =
/// curvature unknown until the service is called), `~surfaces` (folder of surface files), `~mount`,
/// `~rows` and `~columns` (check surface files with one value for each taxel), `~frame_id`.
class CurvatureServer {
 public:
  /// Throws fsr::InputError.
  CurvatureServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

 private:
  bool setSurface(fsr_pressure_map::SetSurface::Request& request,
                  fsr_pressure_map::SetSurface::Response& response);
  void publish();

  ros::NodeHandle handle_;
  SurfaceFolder surfaces_;
  std::string frame_id_;
  fsr::matrix::Surface surface_;
  ros::Publisher publisher_;
  ros::ServiceServer service_;
  ros::Timer timer_;
};

}  // namespace fsr_ros
