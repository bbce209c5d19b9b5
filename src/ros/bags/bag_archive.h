#pragma once

#include <cmath>
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

  bool whole() const { return wanted.empty() && from <= 0 && std::isinf(until); }
};

struct ArchiveResult {
  std::uint64_t messages = 0;
  std::string complaint;  ///< why /scans ends before the recording does; empty = it does not
};

/// Writes messages of a bag, those of other sensors and foreign ones too, as an archive (exports/archive.h).
/// The archive of a whole bag also has the sensor's scans, joined with what else is known of them, in the
/// group /scans; a scan that is malformed ends that group, but not the archive. The bag is read four times
/// and never held. Throws fsr::InputError that names the file and what would be right.
ArchiveResult archiveBag(const std::string& bag, const ArchiveSelection& selection,
                         const std::string& archive);

/// Turns an archive back into a bag: the same messages with topic, type, time of reception and connection
/// header, byte for byte, each held against its hash. Returns the number of messages. Throws fsr::InputError,
/// and then there is no new bag.
std::uint64_t restoreBag(const std::string& archive, const std::string& bag);

}  // namespace fsr_ros
