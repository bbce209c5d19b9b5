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

/// State of a map: why no pressure is shown, or how far the pressure can be trusted.
StatusLine stateStatus(fsr::map::MapState state);

/// Whether messages come.
enum class Flow {
  kNone,     ///< no message has come
  kComing,   ///< the last one is the present state
  kPaused,   ///< none for some seconds, while the ROS time has stood still: a replay is paused, or has ended
  kStopped,  ///< none for some seconds, also of ROS time: the last one is not the present state
};

/// `seconds`: time since the last message; below 0 = no message has come. `ros_seconds`: likewise, in ROS
/// time.
Flow flowOf(double seconds, double ros_seconds);

/// `seconds`: time since the last message on `topic`. `noun`: name of the data, e.g. "map".
StatusLine messageStatus(Flow flow, double seconds, const std::string& noun, const std::string& topic);

/// `flow` for a legend; empty while messages come.
std::string flowHeadline(Flow flow, const std::string& noun);

/// The state for a legend, in capitals so that it is not overlooked; empty for the state OK.
std::string stateHeadline(fsr::map::MapState state);

/// Source of the sheet's shape. `error`: why the last message could not be used; empty = it was used.
StatusLine curvatureStatus(const fsr::matrix::Surface& surface, const std::string& error,
                           const std::string& topic);

/// Number of taxels with an unreliable reading, by kind. With `flags` [taxels] it also says what is
/// extrapolated: reading, curvature or temperature.
StatusLine taxelStatus(const std::vector<fsr::view::TaxelLook>& looks,
                       const std::vector<std::uint16_t>& flags = {});

}  // namespace fsr_rviz
