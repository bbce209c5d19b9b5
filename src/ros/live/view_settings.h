#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <string>

#include "fsr_pressure_map/view/heat_map.h"

namespace fsr_ros {

/// Parameters of the view node; each default stands here or in the struct that it fills.
struct ViewSettings {
  /// Throws fsr::InputError. Warns of parameters that nobody asks for.
  explicit ViewSettings(const ros::NodeHandle& private_handle);

  std::uint32_t queue_size;  ///< `~queue_size` of both ends [messages]
  fsr::view::HeatMapStyle
      style;  ///< `~range_low`, `~range_high` [Pa], `~unit`, `~colour_map`, `~layer`, `~style`, `~image_size`
  bool auto_range;           ///< `~auto_range`: the range's end follows the data, on round values
  int fineness;              ///< `~fineness`: squares of the mesh a taxel and side
  double rate;               ///< `~rate`: most pictures and meshes a second [Hz]
  double contact_threshold;  ///< `~contact_threshold` [Pa]
  std::string regions;       ///< `~regions`: region file, resolved; empty = the whole matrix only
  double stale_after;        ///< `~stale_after`: without a map for as long, statistics say UNKNOWN [s]
};

}  // namespace fsr_ros
