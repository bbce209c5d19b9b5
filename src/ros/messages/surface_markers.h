#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include "fsr_pressure_map/map/map_statistics.h"
#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/view/heat_map.h"
#include "view/sheet_mesh.h"

namespace fsr_ros {

/// What a map's state means for who looks at it, "" = all is well.
std::string stateText(fsr::map::MapState state);

/// The map on its bent sheet for rviz's MarkerArray display, in the frame of `header`: namespaces `sheet`
/// (the coloured mesh), `marks` (strokes on taxels that are not to be believed, see taxel_look.h),
/// `centre_of_pressure` (white), `peak` (black) and `legend` (text: what is shown, its range, the numbers).
/// `whole` are the statistics of the whole matrix.
visualization_msgs::MarkerArray toMarkers(const std_msgs::Header& header, const fsr::map::PressureMap& map,
                                          const fsr::view::SheetMesh& mesh,
                                          const fsr::view::HeatMapStyle& style,
                                          const fsr::map::RegionStatistics& whole);

}  // namespace fsr_ros
