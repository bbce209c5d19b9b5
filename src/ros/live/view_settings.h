#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <string>

#include "fsr_pressure_map/map/region.h"
#include "fsr_pressure_map/view/heat_map.h"

namespace fsr_ros {

/// Parameters of the view node.
struct ViewSettings {
  /// Reads the parameters and warns about unknown ones. Throws fsr::InputError.
  explicit ViewSettings(const ros::NodeHandle& private_handle);

  std::uint32_t queue_size;  ///< `~queue_size` of subscribers and publishers [messages]
  fsr::view::HeatMapStyle
      style;  ///< `~range_low`, `~range_high` [Pa], `~unit`, `~colour_map`, `~layer`, `~style`, `~image_size`
  bool auto_range;           ///< `~auto_range`: the end of the range follows the data in round steps
  int fineness;              ///< `~fineness`: squares of the mesh along each side of a taxel
  double rate;               ///< `~rate`: largest rate of images and meshes [Hz]
  double contact_threshold;  ///< `~contact_threshold` [Pa]
  std::string regions;       ///< `~regions`: region file, resolved; empty = the whole matrix only
  /// Of the whole matrix: `~alarm_threshold` [Pa], `~alarm_dwell` [s], `~alarm_hysteresis` [Pa]. Threshold 0
  /// = as in the region file.
  fsr::map::AlarmOptions alarm;
  std::string kept_alarms;  ///< `~kept_alarms`: what the service set, for a restart after a crash (AlarmDesk)
  double stale_after;       ///< `~stale_after`: time without a map until alarms are UNKNOWN [s]
};

}  // namespace fsr_ros
