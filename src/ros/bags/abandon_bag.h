#pragma once

#include <rosbag/bag.h>

#include <memory>

namespace fsr_ros {

/// Closes a bag whose content is not needed. If the disk is full, rosbag::Bag::close() throws, and so does
/// the destructor, which would end the process. Such a bag is leaked instead of destroyed.
void abandonBag(std::unique_ptr<rosbag::Bag> bag) noexcept;

}  // namespace fsr_ros
