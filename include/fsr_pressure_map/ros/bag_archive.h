#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace fsr_ros {

/// What of a bag goes into an archive.
struct ArchiveSelection {
  std::string topics;               ///< namespace of the sensor; empty = the only one
  std::vector<std::string> wanted;  ///< topics, full names or base names under the namespace; empty = all
  double from = 0;                  ///< since the bag's first message, by time of reception [s]
  double until = std::numeric_limits<double>::infinity();
};

/// Writes messages of a bag, those of other sensors and foreign ones too, as an archive (exports/archive.h).
/// The bag is read twice and never held. Returns the number of messages. Throws fsr::InputError that names
/// the file and what would be right.
std::uint64_t archiveBag(const std::string& bag, const ArchiveSelection& selection,
                         const std::string& archive);

/// Turns an archive back into a bag: the same messages with topic, type, time of reception and connection
/// header, byte for byte, each held against its hash. Returns the number of messages. Throws fsr::InputError,
/// and then there is no new bag.
std::uint64_t restoreBag(const std::string& archive, const std::string& bag);

}  // namespace fsr_ros
