#include <fsr_pressure_map/SetSurface.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <std_msgs/Header.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "fsr_pressure_map/matrix/curvature.h"
#include "matrix/surface_file.h"
#include "ros/bags/resource_path.h"
#include "ros/bags/surface_folder.h"
#include "ros/live/parameters.h"
#include "ros/live/serve.h"
#include "ros/messages/surface_message.h"
#include "ros/messages/view_messages.h"

namespace fsr_ros {

namespace {

// Publishes the scan that a surface was made from on `mesh`, latched, and the transform from the frame of
// the scan, or of the limb, to that of the matrix on /tf_static. rviz then draws scan and map together.
class MeshPublisher {
 public:
  // `mesh_frame`: empty = no transform is published.
  MeshPublisher(ros::NodeHandle& handle, std::string mesh_frame)
      : mesh_frame_(std::move(mesh_frame)),
        mesh_(handle.advertise<visualization_msgs::Marker>("mesh", 1, true)) {
    if (!mesh_frame_.empty()) transform_.emplace();
  }

  // `place`: nothing for a surface that was made from no scan; then the last one disappears. `matrix`: where
  // the matrix lies. A transform cannot be taken back: the last one stays until the node ends. `header`: the
  // frame of the matrix.
  void show(const std_msgs::Header& header, const std::optional<fsr::matrix::MeshPlace>& place,
            const std::optional<fsr::matrix::Pose>& matrix) {
    std::error_code error;
    const bool readable = place && std::filesystem::is_regular_file(place->file, error);
    if (place && !readable) {
      ROS_WARN_STREAM("rviz draws no scan under the matrix: there is no file "
                      << place->file
                      << ", which mesh.file of the surface names, relative to the surface file");
    }
    mesh_.publish(readable ? toMarker(header, *place) : noMesh(header));
    if (matrix && transform_) transform_->sendTransform(toTransform(header, mesh_frame_, *matrix));
  }

 private:
  std::string mesh_frame_;
  ros::Publisher mesh_;
  std::optional<tf2_ros::StaticTransformBroadcaster> transform_;
};

namespace fs = std::filesystem;

class CurvatureServer {
 public:
  CurvatureServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle) : handle_(handle) {
    const Parameters parameters(private_handle);
    const fsr::settings::Range side{1, fsr::matrix::kMaxMatrixSide, ""};
    fsr::matrix::MatrixSize size;
    size.rows = static_cast<std::uint16_t>(parameters.integer("rows", 7, side));
    size.columns = static_cast<std::uint16_t>(parameters.integer("columns", 10, side));
    surfaces_ = SurfaceFolder(parameters.text("surfaces", SurfaceFolder::shipped()), size);
    frame_id_ = parameters.text("frame_id", "fsr_matrix");
    around_ = parameters.number("around", std::nan(""), {-360, 360, "degrees"});
    along_ = parameters.number("along", 0, {-10, 10, "m"});
    start(parameters, private_handle.getNamespace());

    publisher_ = handle_.advertise<fsr_pressure_map::SurfaceCurvature>("curvature", 10, true);
    mesh_publisher_.emplace(handle_, parameters.text("mesh_frame", ""));
    ros::NodeHandle services(private_handle);
    service_ = services.advertiseService("set_surface", &CurvatureServer::setSurface, this);
    timer_ = handle_.createTimer(ros::Duration(1.0), [this](const ros::TimerEvent&) { publish(); });
    publish();
    showPlace();
  }

  ~CurvatureServer() {
    try {
      memory_->end();
    } catch (const fsr::settings::InputError&) {
      // The file could not be written before either, which setSurface() has logged.
    }
  }

  CurvatureServer(const CurvatureServer&) = delete;
  CurvatureServer& operator=(const CurvatureServer&) = delete;

 private:
  bool setSurface(fsr_pressure_map::SetSurface::Request& request,
                  fsr_pressure_map::SetSurface::Response& response) {
    answer(response, [&] {
      lay({request.surface, request.mount != 0 ? request.mount : surface_.mount + 1});
      publish();
      showPlace();
      return "the matrix lies on " + surface_.name + " (mount " + std::to_string(surface_.mount) +
             "), from " + fs::absolute(surfaces_.pathOf(request.surface)).string() +
             keptText({request.surface, surface_.mount});
    });
    if (!response.success)
      response.message += "; the surface is still " + (surface_.known() ? surface_.name : "unknown");
    return true;
  }

  void publish() {
    fsr_pressure_map::SurfaceCurvature message = toMessage(surface_);
    message.header = headerNow();
    publisher_.publish(message);
  }

  void showPlace() {
    std::optional<fsr::matrix::Pose> matrix;
    if (!std::isnan(around_)) matrix = fsr::matrix::onLimb(surface_, around_ * M_PI / 180, along_);
    if (mesh_) matrix = mesh_->matrix;
    mesh_publisher_->show(headerNow(), mesh_, matrix);
  }

  std_msgs::Header headerNow() const {
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    header.frame_id = frame_id_;
    return header;
  }

  // Stores the surface; says what follows if that fails.
  std::string keptText(const LaidOn& now) {
    try {
      memory_->keep(now);
      return "";
    } catch (const fsr::settings::InputError& error) {
      const std::string complaint = std::string("; it will be forgotten when the node ends: ") + error.what();
      ROS_ERROR_STREAM("the matrix lies on " << now.text() << complaint);
      return complaint;
    }
  }

  // Takes over a surface, or leaves the old one and throws.
  void lay(const LaidOn& next) {
    fsr::matrix::Surface surface = surfaces_.load(next.surface);
    mesh_ = surfaces_.meshOf(next.surface);
    surface_ = std::move(surface);
    surface_.mount = next.mount;
  }

  void start(const Parameters& parameters, const std::string& node) {
    LaidOn launched;
    launched.surface = parameters.text("surface", "");
    if (launched.surface.find('/') != std::string::npos)
      launched.surface = resolveLaunchPath(launched.surface);
    launched.mount = static_cast<std::uint32_t>(parameters.integer("mount", 1, {0, 1e9, ""}));
    if (!launched.surface.empty()) lay(launched);
    surface_.mount = launched.mount;
    memory_ = std::make_unique<SurfaceMemory>(ownFile(parameters, "surface_file", node, "surface"), launched);
    if (!memory_->remark().empty()) ROS_WARN_STREAM(node << ": " << memory_->remark());
    if (memory_->start() == launched) return;
    try {
      lay(memory_->start());
    } catch (const fsr::settings::InputError& error) {
      surface_ = {};  // the launch file's would be wrong
      mesh_.reset();
      ROS_ERROR_STREAM(node << ": the surface is unknown until ~set_surface is called, because "
                            << error.what());
    }
  }

  ros::NodeHandle handle_;
  SurfaceFolder surfaces_;
  std::string frame_id_;
  fsr::matrix::Surface surface_;
  std::optional<fsr::matrix::MeshPlace> mesh_;  // under the matrix
  double around_, along_;                       // place on a limb without a scan [degrees], [m]; NaN = none
  std::unique_ptr<SurfaceMemory> memory_;
  ros::Publisher publisher_;
  std::optional<MeshPublisher> mesh_publisher_;
  ros::ServiceServer service_;
  ros::Timer timer_;
};

}  // namespace

Server makeCurvatureServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle) {
  return std::make_shared<CurvatureServer>(handle, private_handle);
}

}  // namespace fsr_ros
