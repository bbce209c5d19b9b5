#pragma once

#include <rosbag/bag.h>

#include <memory>

namespace fsr_ros {

/// Closes a bag that is thrown away. One whose disk is full throws as it is closed, and, destroyed, once
/// more, which ends the process: such a bag is never destroyed.
void abandonBag(std::unique_ptr<rosbag::Bag> bag) noexcept;

}  // namespace fsr_ros
