#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "fsr_pressure_map/map/map_statistics.h"
#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/view/heat_map.h"
#include "view/sheet_mesh.h"

namespace fsr_ros {

/// The state of a map in words; "" for the state OK.
std::string stateText(fsr::map::MapState state);

/// The state of a map in words and whether its history is not settled, joined by "; "; "" if there is nothing
/// to say.
std::string remarkText(const fsr::map::PressureMap& map);

/// The map on its bent sheet for the MarkerArray display of rviz, in the frame of `header`. Namespaces:
/// `sheet` (the coloured mesh), `marks` (strokes on taxels with an unreliable reading, see taxel_look.h),
/// `centre_of_pressure` (white), `peak` (black) and `legend` (text with quantity, range, peak and mean).
/// `whole` are the statistics of the whole matrix, `state` is the legend's last line; empty = none.
visualization_msgs::MarkerArray toMarkers(const std_msgs::Header& header, const fsr::map::PressureMap& map,
                                          const fsr::view::SheetMesh& mesh,
                                          const fsr::view::HeatMapStyle& style,
                                          const fsr::map::RegionStatistics& whole, const std::string& state);

}  // namespace fsr_ros
