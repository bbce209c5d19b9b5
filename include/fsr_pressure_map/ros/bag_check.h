#pragma once

#include <string>

namespace fsr_ros {

/// Walks a bag's records from end to end before rosbag opens it: rosbag believes every length and offset in
/// the file, and one that is wrong makes it read outside of its memory. Throws fsr::InputError where records
/// do not tile the file or an index points elsewhere than at a message of its connection,
/// rosbag::BagUnindexedException where the bag was not closed. Memory: one chunk of the bag, and eight bytes for each of its messages.
///
/// Inside a compressed chunk nothing is looked at: what it holds is trusted to its own checksum.
void requireSoundBag(const std::string& path);

}  // namespace fsr_ros
