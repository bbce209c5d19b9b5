#pragma once

#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/node_handle.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/map_statistics.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "ros/live/alarm_desk.h"
#include "ros/live/view_settings.h"
#include "view/legend.h"
#include "view/sheet_mesh.h"

namespace fsr_ros {

/// The shape of the bent sheet for the last layout and surface. It is computed on request, and again only
/// after the layout or the surface has changed.
class SheetShape {
 public:
  explicit SheetShape(int fineness) : fineness_(fineness) {}

  void setSurface(fsr::matrix::Surface surface);
  /// If the surface does not fit the layout, the next of the calls below throws fsr::InputError.
  void setLayout(const fsr::matrix::Layout& layout);

  const std::vector<fsr::view::TaxelPose>& poses();
  const fsr::view::SheetMesh& mesh();
  const std::vector<double>& areas();  ///< area of each taxel on the bent sheet, row-major [m^2]

 private:
  void forget();

  int fineness_;
  fsr::matrix::Surface surface_;
  fsr::matrix::Layout layout_;
  std::optional<std::vector<fsr::view::TaxelPose>> poses_;
  std::optional<fsr::view::SheetMesh> mesh_;
  std::optional<std::vector<double>> areas_;
};

/// Publishes pictures and statistics of the pressure map in the frame of the scan: `points`, `surface`,
/// `image`, `statistics`, `centre_of_pressure`. The sheet is bent as `curvature` says, and flat while the
/// curvature is unknown. The node receives maps only while one of its topics has a subscriber or an alarm is
/// set. `surface` and `image` are published at most at `~rate`, the other topics for every map. The
/// pressure-time integral begins with the first subscriber. When maps stop, all alarms become UNKNOWN, and
/// `surface` and `image` lose their colours unless the ROS time stands still, as in a paused replay. The
/// service `~set_alarm` sets alarms; they are logged and published on `events`. Parameters: ViewSettings.
class ViewServer {
 public:
  /// Throws fsr::InputError.
  ViewServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

 private:
  bool wanted(const std::string& topic) const { return outputs_.at(topic).getNumSubscribers() > 0; }
  void followSubscribers();
  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message);
  void onMap(const fsr_pressure_map::PressureMapConstPtr& message);
  void publish(const fsr_pressure_map::PressureMap& message, const fsr::map::PressureMap& map);
  void publishPictures(const fsr_pressure_map::PressureMap& message, const fsr::map::PressureMap& map,
                       const std::string& state);
  void publishStopped();
  void publishStatistics(const std_msgs::Header& header,
                         const std::vector<fsr::map::RegionStatistics>& regions);
  void publishCentre(const std_msgs::Header& header, const fsr::map::RegionStatistics& whole);
  void reportSilence();
  void prepare(const fsr::matrix::Layout& layout);
  void onAlarmSet();
  const fsr::map::RegionStatistics& whole() const { return now_.front(); }

  ros::NodeHandle handle_;
  ViewSettings settings_;
  std::map<std::string, ros::Publisher> outputs_;
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

}  // namespace fsr_ros
