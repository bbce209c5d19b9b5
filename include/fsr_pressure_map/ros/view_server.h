#pragma once

#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/node_handle.h>

#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/view/bent_sheet.h"

namespace fsr_ros {

/// Publishes `points`: the pressure map on its sheet, bent by `curvature` (flat while that is unknown), in
/// the frame of the scan. Works only while somebody subscribes: else it does not even receive maps.
///
/// Parameter: `~queue_size` of both ends [messages].
class ViewServer {
 public:
  /// Throws fsr::InputError.
  ViewServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

 private:
  void followSubscribers();
  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message);
  void onMap(const fsr_pressure_map::PressureMapConstPtr& message);
  const std::vector<fsr::TaxelPose>& poses(const fsr::Layout& layout);

  ros::NodeHandle handle_;
  std::uint32_t queue_size_;
  ros::Publisher points_;
  ros::Subscriber maps_;
  ros::Subscriber curvature_;

  fsr::Surface surface_;
  fsr::Layout layout_;                 // that poses_ were made for
  std::vector<fsr::TaxelPose> poses_;  // empty = to be made anew
};

}  // namespace fsr_ros
