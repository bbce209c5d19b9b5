#pragma once

#include <rviz/properties/status_property.h>

#include <string>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "view/taxel_look.h"

namespace fsr_rviz {

/// A line of the display's status.
struct StatusLine {
  rviz::StatusProperty::Level level = rviz::StatusProperty::Ok;
  std::string text;
};

/// Why no pressure is shown, or what is to be kept in mind about the one that is.
StatusLine stateStatus(fsr::map::MapState state);

/// `seconds` since the last message; below 0 = none ever came on `topic`. `noun`: what it is, e.g. "map".
StatusLine messageStatus(double seconds, const std::string& noun, const std::string& topic);

/// Whether data of that age [s] are no longer what is there now.
bool isSilent(double seconds);

/// The state for a legend, in capitals: it must not be overlooked; empty = nothing to say.
std::string stateHeadline(fsr::map::MapState state);

/// What the sheet's shape comes from; `error` where the last message could not be used.
StatusLine curvatureStatus(const fsr::matrix::Surface& surface, const std::string& error,
                           const std::string& topic);

/// How many taxels are not to be believed as they stand.
StatusLine taxelStatus(const std::vector<fsr::view::TaxelLook>& looks);

}  // namespace fsr_rviz
