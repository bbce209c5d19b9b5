#include "ros/live/serve.h"

#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <geometry_msgs/PointStamped.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/map_statistics.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/ros/pressure_map_message.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/alarm_desk.h"
#include "ros/live/view_settings.h"
#include "ros/messages/surface_message.h"
#include "ros/messages/view_messages.h"
#include "view/legend.h"
#include "view/sheet_mesh.h"

namespace fsr_ros {

namespace {

// The shape of the bent sheet for the last layout and surface. It is computed on request, and again only
// after the layout or the surface has changed.
class SheetShape {
 public:
  explicit SheetShape(int fineness) : fineness_(fineness) {}

  void setSurface(fsr::matrix::Surface surface) {
    if (fsr::matrix::sameCondition(surface, surface_)) return;
    surface_ = std::move(surface);
    forget();
  }

  // If the surface does not fit the layout, the next of the calls below throws fsr::InputError.
  void setLayout(const fsr::matrix::Layout& layout) {
    if (layout.size == layout_.size && layout.pitch_x == layout_.pitch_x &&
        layout.pitch_y == layout_.pitch_y) {
      return;
    }
    layout_ = layout;
    forget();
  }

  const std::vector<fsr::view::TaxelPose>& poses() {
    if (!poses_) poses_ = fsr::view::bendSheet(layout_, surface_);
    return *poses_;
  }

  const fsr::view::SheetMesh& mesh() {
    if (!mesh_) mesh_.emplace(layout_, surface_, fineness_);
    return *mesh_;
  }

  // Area of each taxel on the bent sheet, row-major [m^2].
  const std::vector<double>& areas() {
    if (!areas_) areas_ = fsr::view::taxelAreas(layout_, surface_);
    return *areas_;
  }

 private:
  void forget() {
    poses_.reset();
    mesh_.reset();
    areas_.reset();
  }

  int fineness_;
  fsr::matrix::Surface surface_;
  fsr::matrix::Layout layout_;
  std::optional<std::vector<fsr::view::TaxelPose>> poses_;
  std::optional<fsr::view::SheetMesh> mesh_;
  std::optional<std::vector<double>> areas_;
};

constexpr double kViewComplaintPeriod = 10.0;  // [s]

// Topic of one region, with its name as far as a topic may have it.
std::string regionTopic(const std::string& region) {
  std::string name = region.empty() ? fsr::map::kWholeMatrix : region;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return "regions/" + name;
}

class ViewServer {
 public:
  ViewServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
      : handle_(handle),
        settings_(private_handle),
        shape_(settings_.fineness),
        statistics_({}, 0),
        alarms_(handle, private_handle, settings_, [this] { onAlarmSet(); }),
        auto_range_(std::max(10e3, 1.5 * settings_.style.scale.low)) {
    const std::uint32_t queue = settings_.queue_size;
    outputs_["points"] = handle_.advertise<sensor_msgs::PointCloud2>("points", queue, follow_, follow_);
    outputs_["surface"] =
        handle_.advertise<visualization_msgs::MarkerArray>("surface", queue, follow_, follow_);
    outputs_["image"] = handle_.advertise<sensor_msgs::Image>("image", queue, follow_, follow_);
    outputs_["statistics"] =
        handle_.advertise<fsr_pressure_map::PressureStatisticsArray>("statistics", queue, follow_, follow_);
    outputs_["centre_of_pressure"] =
        handle_.advertise<geometry_msgs::PointStamped>("centre_of_pressure", queue, follow_, follow_);
    advertiseRegions();
    silence_ = handle_.createWallTimer(ros::WallDuration(0.5 * settings_.stale_after),
                                       [this](const ros::WallTimerEvent&) { reportSilence(); });
    followSubscribers();
  }

 private:
  bool wanted(const std::string& topic) const { return outputs_.at(topic).getNumSubscribers() > 0; }

  void followSubscribers() {
    const bool anybody = std::any_of(outputs_.begin(), outputs_.end(), [](const auto& output) {
      return output.second && output.second.getNumSubscribers() > 0;
    });
    if (!anybody) statistics_.resetIntegral();
    if (!anybody && !alarms_.any()) {
      maps_.shutdown();
      curvature_.shutdown();
    } else if (!maps_) {
      last_map_ = ros::WallTime::now();
      curvature_ = handle_.subscribe("curvature", settings_.queue_size, &ViewServer::onCurvature, this);
      maps_ = handle_.subscribe("pressure_map", settings_.queue_size, &ViewServer::onMap, this,
                                ros::TransportHints().tcpNoDelay());
    }
  }

  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message) {
    try {
      shape_.setSurface(toSurface(*message));
    } catch (const fsr::settings::InputError& error) {
      ROS_WARN_STREAM_THROTTLE(kViewComplaintPeriod, error.what());
    }
  }

  void onMap(const fsr_pressure_map::PressureMapConstPtr& message) {
    last_map_ = ros::WallTime::now();
    last_map_ros_ = ros::Time::now();
    frame_id_ = message->header.frame_id;
    try {
      const fsr::map::PressureMap map = toPressureMap(*message);
      if (map.layout.size.taxels() == 0) return;
      shape_.setLayout(map.layout);
      if (map.layout.size != size_) prepare(map.layout);
      now_ = statistics_.update(message->header.stamp.toSec(), map, shape_.areas());
      alarms_.note(message->header, now_);
      publish(*message, map);
      shown_ = message;
    } catch (const fsr::settings::InputError& error) {
      ROS_WARN_STREAM_THROTTLE(kViewComplaintPeriod, error.what());
    }
  }

  void publish(const fsr_pressure_map::PressureMap& message, const fsr::map::PressureMap& map) {
    publishStatistics(message.header, now_);
    if (wanted("centre_of_pressure")) publishCentre(message.header, whole());
    if (wanted("points")) {
      sensor_msgs::PointCloud2 cloud = toPoints(map, shape_.poses());
      cloud.header = message.header;
      outputs_["points"].publish(cloud);
    }
    if (settings_.auto_range) {
      const std::vector<float>& values = fsr::view::layerOf(map, settings_.style.layer);
      double highest = fsr::map::RegionStatistics::kNone;
      for (const float value : values) highest = std::fmax(highest, double(value));
      settings_.style.scale.high = auto_range_.update(message.header.stamp.toSec(), highest);
    }
    const ros::WallTime now = ros::WallTime::now();
    if (now < next_picture_ || !(wanted("surface") || wanted("image"))) return;
    next_picture_ = std::max(next_picture_ + ros::WallDuration(1 / settings_.rate), now);
    publishPictures(message, map, remarkText(map));
  }

  void publishPictures(const fsr_pressure_map::PressureMap& message, const fsr::map::PressureMap& map,
                       const std::string& state) {
    if (wanted("surface")) {
      outputs_["surface"].publish(
          toMarkers(message.header, map, shape_.mesh(), settings_.style, whole(), state));
    }
    if (wanted("image")) {
      const std::string calibration =
          message.scheme.empty() ? "no calibration" : "calibration " + message.scheme;
      const fsr::view::PressureUnit unit = settings_.style.scale.unit;
      const bool at_least = whole().at_least > 0;
      const std::string numbers = "peak " + fsr::view::limitText(whole().peak, unit, at_least) + "  mean " +
                                  fsr::view::limitText(whole().mean, unit, at_least);
      const fsr::view::HeatMap painter(settings_.style);
      outputs_["image"].publish(toMessage(message.header, painter.draw(map, {calibration, numbers, state})));
    }
  }

  // Takes the colours from the pictures of the last map, once. The ROS time stands still in a paused replay.
  void publishStopped() {
    if (!shown_ || (ros::Time::now() - last_map_ros_).toSec() < settings_.stale_after) return;
    fsr::map::PressureMap map = toPressureMap(*shown_);
    const auto none = static_cast<float>(fsr::map::RegionStatistics::kNone);
    map.pressure.assign(map.pressure.size(), none);
    map.deviation.assign(map.deviation.size(), none);
    publishPictures(*shown_, map, "STOPPED: no more maps");
    shown_.reset();
  }

  void publishStatistics(const std_msgs::Header& header,
                         const std::vector<fsr::map::RegionStatistics>& regions) {
    fsr_pressure_map::PressureStatisticsArray array;
    array.header = header;
    fsr::matrix::Layout layout;
    layout.size = size_;
    const bool all = wanted("statistics");
    for (std::size_t r = 0; r < regions.size(); ++r) {
      const bool own = r < regions_.size() && regions_[r].getNumSubscribers() > 0;
      if (own) regions_[r].publish(toMessage(regions[r], layout));
      if (all) array.regions.push_back(toMessage(regions[r], layout));
    }
    if (all) outputs_["statistics"].publish(array);
  }

  void publishCentre(const std_msgs::Header& header, const fsr::map::RegionStatistics& whole) {
    if (!whole.centre) return;
    geometry_msgs::PointStamped message;
    message.header = header;
    message.point.x = whole.centre->x;
    message.point.y = whole.centre->y;
    outputs_["centre_of_pressure"].publish(message);
  }

  // Without maps the alarms are published as UNKNOWN, so that a subscriber does not take silence for OK.
  void reportSilence() {
    if (!maps_) return;
    if ((ros::WallTime::now() - last_map_).toSec() < settings_.stale_after) return;
    if (statistics_.regions().empty()) {
      statistics_ = fsr::map::MapStatistics({fsr::map::Region{}}, settings_.contact_threshold);
      alarms_.apply(statistics_);
    }
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    header.frame_id = frame_id_;
    now_ = statistics_.stale();
    alarms_.note(header, now_);
    publishStatistics(header, now_);
    publishStopped();
  }

  // A topic for each region: programs that plot numbers find no region in an array.
  void advertiseRegions() {
    std::vector<std::string> names = {""};
    try {
      if (!settings_.regions.empty()) names = fsr::map::regionNames(settings_.regions);
    } catch (const fsr::settings::InputError&) {  // prepare() says it
    }
    for (const std::string& name : names) {
      regions_.push_back(handle_.advertise<fsr_pressure_map::PressureStatistics>(
          regionTopic(name), settings_.queue_size, follow_, follow_));
      outputs_[regionTopic(name)] = regions_.back();
    }
  }

  // Regions need the matrix size, which is known from the first map on.
  void prepare(const fsr::matrix::Layout& layout) {
    std::vector<fsr::map::Region> regions(1);
    try {
      if (!settings_.regions.empty()) regions = fsr::map::readRegionFile(settings_.regions, layout.size);
    } catch (const fsr::settings::InputError& error) {
      ROS_ERROR_STREAM(
          error.what()
          << "; until the node is restarted, the statistics have no regions but the whole matrix");
    }
    statistics_ = fsr::map::MapStatistics(std::move(regions), settings_.contact_threshold);
    size_ = layout.size;
    alarms_.learn(statistics_.regions());
    alarms_.apply(statistics_);
    followSubscribers();  // the file may set no alarm
  }

  void onAlarmSet() {
    alarms_.apply(statistics_);
    followSubscribers();
  }

  const fsr::map::RegionStatistics& whole() const { return now_.front(); }

  ros::NodeHandle handle_;
  ViewSettings settings_;
  std::map<std::string, ros::Publisher> outputs_;
  std::vector<ros::Publisher> regions_;  // those of outputs_ for one region each, in the order of the file
  ros::SubscriberStatusCallback follow_ = [this](const auto&) { followSubscribers(); };
  ros::Subscriber maps_;
  ros::Subscriber curvature_;
  ros::WallTimer silence_;

  SheetShape shape_;
  fsr::matrix::MatrixSize size_;  // matrix size of statistics_
  fsr::map::MapStatistics statistics_;
  std::vector<fsr::map::RegionStatistics> now_;
  AlarmDesk alarms_;
  fsr::view::AutoRange auto_range_;
  std::string frame_id_;
  ros::WallTime last_map_;
  ros::Time last_map_ros_;
  fsr_pressure_map::PressureMapConstPtr shown_;  // the last map, until the pictures have said that it is old
  ros::WallTime next_picture_;
};

}  // namespace

Server makeViewServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle) {
  return std::make_shared<ViewServer>(handle, private_handle);
}

}  // namespace fsr_ros
