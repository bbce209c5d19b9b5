#include "ros/live/mesh_publisher.h"

#include <ros/console.h>

#include <filesystem>
#include <utility>

#include "ros/messages/mesh_messages.h"

namespace fsr_ros {

MeshPublisher::MeshPublisher(ros::NodeHandle& handle, std::string mesh_frame)
    : mesh_frame_(std::move(mesh_frame)),
      mesh_(handle.advertise<visualization_msgs::Marker>("mesh", 1, true)) {
  if (!mesh_frame_.empty()) transform_.emplace();
}

void MeshPublisher::show(const std_msgs::Header& header, const std::optional<fsr::matrix::MeshPlace>& place) {
  std::error_code error;
  const bool readable = place && std::filesystem::is_regular_file(place->file, error);
  if (place && !readable) {
    ROS_WARN_STREAM("rviz draws no scan under the matrix: there is no file "
                    << place->file << ", which mesh.file of the surface names, relative to the surface file");
  }
  mesh_.publish(readable ? toMarker(header, *place) : noMesh(header));
  if (place && transform_) transform_->sendTransform(toTransform(header, mesh_frame_, place->matrix));
}

}  // namespace fsr_ros
