#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/view/bent_sheet.h"

namespace fsr_ros {

/// The map as points on the bent sheet [rows x columns]. Fields: x, y, z [m] and intensity (gauge pressure
/// [Pa], NaN = no reading) as float32; row, column and flags (see PressureMap.msg) as uint16. `poses` has one
/// entry for each taxel, row-major. The header is left empty.
sensor_msgs::PointCloud2 toPoints(const fsr::map::PressureMap& map,
                                  const std::vector<fsr::view::TaxelPose>& poses);

}  // namespace fsr_ros
