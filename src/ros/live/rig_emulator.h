#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <memory>

#include "emulator/emulator.h"
#include "ros/live/serve.h"

namespace fsr_ros {

/// Makes the person at the rig.
using MakePerson =
    std::function<std::shared_ptr<fsr::emulator::Operator>(const fsr::emulator::OperatorOptions&)>;

/// The same as in serve.h with another operator, e.g. one who makes mistakes. Throws fsr::InputError.
Server makeRigEmulator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                       const MakePerson& make);

}  // namespace fsr_ros
