#pragma once

#include <sensor_msgs/Image.h>

#include "fsr_pressure_map/view/image.h"

namespace fsr_ros {

/// The image with encoding rgb8.
sensor_msgs::Image toMessage(const std_msgs::Header& header, fsr::view::Image image);

}  // namespace fsr_ros
