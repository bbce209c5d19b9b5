#pragma once

#include <ros/node_handle.h>
#include <std_msgs/Header.h>

#include <optional>
#include <string>

#include "matrix/surface_file.h"

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
  ros::Publisher transform_;
};

}  // namespace fsr_ros
