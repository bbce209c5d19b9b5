#pragma once

#include <fsr_pressure_map/SetSurface.h>
#include <ros/node_handle.h>
#include <std_msgs/Header.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <memory>
#include <optional>
#include <string>

#include "fsr_pressure_map/matrix/curvature.h"
#include "matrix/surface_file.h"
#include "ros/bags/surface_folder.h"
#include "ros/bags/surface_memory.h"
#include "ros/live/parameters.h"

namespace fsr_ros {

/// Publishes the scan that a surface was made from on `mesh`, latched, and the transform from the frame of
/// the scan to that of the matrix on /tf_static. rviz then draws scan and map together.
class MeshPublisher {
 public:
  /// `mesh_frame`: empty = no transform is published.
  MeshPublisher(ros::NodeHandle& handle, std::string mesh_frame);

  /// `place`: nothing for a surface that was made from no scan; then the last one disappears. A transform
  /// cannot be taken back: the last one stays until the node ends. `header`: the frame of the matrix.
  void show(const std_msgs::Header& header, const std::optional<fsr::matrix::MeshPlace>& place);

 private:
  std::string mesh_frame_;
  ros::Publisher mesh_;
  std::optional<tf2_ros::StaticTransformBroadcaster> transform_;
};

/// Publishes the surface under the matrix on `curvature`, latched and repeated each second of ROS time, so
/// that every part of a bag contains it. The service `~set_surface` changes the surface. Where the surface
/// file names a scan, the scan is published on `mesh` (MeshPublisher).
///
/// Parameters: `~surface` (name of a file in `~surfaces`, or path of a surface file; empty = unknown until
/// the service is called), `~surfaces` (folder of surface files), `~mount`, `~rows` and `~columns` (surface
/// files with one value for each taxel must fit them), `~frame_id` (of the matrix), `~mesh_frame` (of scans;
/// empty = no transform),
/// `~surface_file` (keeps what ~set_surface said, for a node that died; see SurfaceMemory).
class CurvatureServer {
 public:
  /// Throws fsr::InputError.
  CurvatureServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);
  ~CurvatureServer();
  CurvatureServer(const CurvatureServer&) = delete;
  CurvatureServer& operator=(const CurvatureServer&) = delete;

 private:
  bool setSurface(fsr_pressure_map::SetSurface::Request& request,
                  fsr_pressure_map::SetSurface::Response& response);
  void publish();
  std_msgs::Header headerNow() const;
  std::string keptText(const LaidOn& now);
  void lay(const LaidOn& next);
  void start(const Parameters& parameters, const std::string& node);

  ros::NodeHandle handle_;
  SurfaceFolder surfaces_;
  std::string frame_id_;
  fsr::matrix::Surface surface_;
  std::optional<fsr::matrix::MeshPlace> mesh_;  // under the matrix
  std::unique_ptr<SurfaceMemory> memory_;
  ros::Publisher publisher_;
  std::optional<MeshPublisher> mesh_publisher_;
  ros::ServiceServer service_;
  ros::Timer timer_;
};

}  // namespace fsr_ros
