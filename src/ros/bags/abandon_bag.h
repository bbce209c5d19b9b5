#pragma once

#include <rosbag/bag.h>

#include <memory>

namespace fsr_ros {

/// Closes a bag whose content is not needed. If the disk is full, rosbag::Bag::close() throws, and so does
/// the destructor, which would end the process. Such a bag is leaked instead of destroyed.
void abandonBag(std::unique_ptr<rosbag::Bag> bag) noexcept;

/// Abandons a bag so that nothing is written to its file any more. Otherwise the C library would write what
/// it still keeps when the process ends, into a file that others may have completed meanwhile.
void releaseFile(std::unique_ptr<rosbag::Bag> bag) noexcept;

/// Writes what the C library still keeps of a bag to its file, so that neither a kill nor a disk that fills
/// later can lose it. Throws rosbag::BagIOException.
void flushBag(rosbag::Bag& bag);

}  // namespace fsr_ros
