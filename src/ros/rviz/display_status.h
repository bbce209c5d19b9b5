#pragma once

#include <rviz/properties/status_property.h>

#include <string>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/curvature.h"

namespace fsr_rviz {

/// A line of the display's status.
struct StatusLine {
  rviz::StatusProperty::Level level = rviz::StatusProperty::Ok;
  std::string text;
};

/// Why no pressure is shown, or what is to be kept in mind about the one that is.
StatusLine stateStatus(fsr::MapState state);

/// `seconds` since the last map; below 0 = none ever came on `topic`.
StatusLine mapStatus(double seconds, const std::string& topic);

/// What the sheet's shape comes from; `error` where the last message could not be used.
StatusLine curvatureStatus(const fsr::Surface& surface, const std::string& error, const std::string& topic);

/// How many taxels are not to be believed as they stand.
StatusLine taxelStatus(const fsr::PressureMap& map);

}  // namespace fsr_rviz
