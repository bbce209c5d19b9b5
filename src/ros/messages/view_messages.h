#pragma once

#include <fsr_pressure_map/PressureStatistics.h>
#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "fsr_pressure_map/map/map_statistics.h"
#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/view/bent_sheet.h"
#include "fsr_pressure_map/view/heat_map.h"
#include "fsr_pressure_map/view/image.h"
#include "matrix/surface_file.h"
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

/// The map as points on the bent sheet [rows x columns]. Fields: x, y, z [m] and intensity (gauge pressure
/// [Pa], NaN = no reading) as float32; row, column and flags (see PressureMap.msg) as uint16. `poses` has one
/// entry for each taxel, row-major. The header is left empty.
sensor_msgs::PointCloud2 toPoints(const fsr::map::PressureMap& map,
                                  const std::vector<fsr::view::TaxelPose>& poses);

/// The image with encoding rgb8.
sensor_msgs::Image toMessage(const std_msgs::Header& header, fsr::view::Image image);

/// Converts statistics to a message, without header. `layout` is needed for the row and column of the peak.
/// The centre of pressure is NaN without contact.
fsr_pressure_map::PressureStatistics toMessage(const fsr::map::RegionStatistics& statistics,
                                               const fsr::matrix::Layout& layout);

/// Converts a message back, except for the taxel of the peak and the centre of pressure, which apply to one
/// sheet only.
fsr::map::RegionStatistics toStatistics(const fsr_pressure_map::PressureStatistics& message);

/// The scan of a surface for the Marker display of rviz, which reads the file itself. `header`: the frame of
/// the matrix. It is see-through, because the sheet may be behind it, and 1 mm behind
/// the sheet.
visualization_msgs::Marker toMarker(const std_msgs::Header& header, const fsr::matrix::MeshPlace& place);

/// Takes the scan away again.
visualization_msgs::Marker noMesh(const std_msgs::Header& header);

/// The pose of the matrix frame, that of `header`, in the frame of the mesh.
geometry_msgs::TransformStamped toTransform(const std_msgs::Header& header, const std::string& mesh_frame,
                                            const fsr::matrix::Pose& matrix);

/// "file://" and an absolute path, with the characters escaped that a URL may not contain.
std::string fileUrl(const std::string& path);

}  // namespace fsr_ros
