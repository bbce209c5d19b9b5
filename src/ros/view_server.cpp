#include "fsr_pressure_map/ros/view_server.h"

#include <sensor_msgs/PointCloud2.h>

#include "fsr_pressure_map/ros/bent_points.h"
#include "fsr_pressure_map/ros/parameters.h"
#include "fsr_pressure_map/ros/pressure_map_message.h"
#include "fsr_pressure_map/ros/surface_message.h"

namespace fsr_ros {

namespace {

constexpr double kComplaintPeriod = 10.0;  // [s]

bool same(const fsr::Layout& a, const fsr::Layout& b) {
  return a.size == b.size && a.pitch_x == b.pitch_x && a.pitch_y == b.pitch_y;
}

}  // namespace

ViewServer::ViewServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
    : handle_(handle),
      queue_size_(static_cast<std::uint32_t>(
          Parameters(private_handle).integer("queue_size", 10, {1, 100000, "messages"}))) {
  const auto follow = [this](const ros::SingleSubscriberPublisher&) { followSubscribers(); };
  points_ = handle_.advertise<sensor_msgs::PointCloud2>("points", queue_size_, follow, follow);
}

void ViewServer::followSubscribers() {
  if (points_.getNumSubscribers() == 0) {
    maps_.shutdown();
    curvature_.shutdown();
  } else if (!maps_) {
    curvature_ = handle_.subscribe("curvature", queue_size_, &ViewServer::onCurvature, this);
    maps_ = handle_.subscribe("pressure_map", queue_size_, &ViewServer::onMap, this,
                              ros::TransportHints().tcpNoDelay());
  }
}

void ViewServer::onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message) {
  try {
    fsr::Surface surface = toSurface(*message);
    if (fsr::sameCondition(surface, surface_)) return;
    surface_ = std::move(surface);
    poses_.clear();
  } catch (const fsr::InputError& error) {
    ROS_WARN_STREAM_THROTTLE(kComplaintPeriod, error.what());
  }
}

void ViewServer::onMap(const fsr_pressure_map::PressureMapConstPtr& message) {
  try {
    const fsr::PressureMap map = toPressureMap(*message);
    sensor_msgs::PointCloud2 cloud = toPoints(map, poses(map.layout));
    cloud.header = message->header;
    points_.publish(cloud);
  } catch (const fsr::InputError& error) {
    ROS_WARN_STREAM_THROTTLE(kComplaintPeriod, error.what());
  }
}

const std::vector<fsr::TaxelPose>& ViewServer::poses(const fsr::Layout& layout) {
  if (poses_.empty() || !same(layout, layout_)) {
    poses_ = fsr::bendSheet(layout, surface_);
    layout_ = layout;
  }
  return poses_;
}

}  // namespace fsr_ros
