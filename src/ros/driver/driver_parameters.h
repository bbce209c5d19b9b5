#pragma once

#include "ros/live/parameters.h"
#include "ros/messages/driver_settings.h"

namespace fsr_ros {

/// Reads and checks the driver's private parameters. Throws fsr::settings::InputError.
DriverSettings readDriverSettings(const Parameters& parameters);

}  // namespace fsr_ros
