#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace fsr_ros {

/// Which messages of a bag go into an archive.
struct ArchiveSelection {
  std::string topics;               ///< namespace of the sensor; empty = the only one
  std::vector<std::string> wanted;  ///< topics, full names or base names under the namespace; empty = all
  double from = 0;                  ///< start, since the bag's first message, by time of reception [s]
  double until = std::numeric_limits<double>::infinity();  ///< end, likewise [s]
  /// Is called now and then with what is done and its share; none = nobody asks.
  std::function<void(const std::string& step, double share)> progress = {};

  bool whole() const { return wanted.empty() && from <= 0 && std::isinf(until); }
};

struct ArchiveResult {
  std::uint64_t messages = 0;
  std::string complaint;  ///< why the group /scans is incomplete; empty = it is complete
};

/// Writes the messages of a bag, including those of other sensors and of unknown types, to an archive
/// (exports/archive.h). The archive of a whole bag also has the group /scans: the sensor's scans together
/// with chamber pressure, temperature, surface, session and events at their stamps. A malformed scan ends
/// that group, but not the archive. The bag is read four times and never held in memory. Throws
/// fsr::InputError that names the file and what would be right.
ArchiveResult archiveBag(const std::string& bag, const ArchiveSelection& selection,
                         const std::string& archive);

/// Turns an archive back into a bag with the same messages: topic, type, time of reception, connection header
/// and bytes are equal, and each message is checked against its hash. Returns the number of messages. Throws
/// fsr::InputError; in that case no bag is left. `progress`: as ArchiveSelection::progress.
std::uint64_t restoreBag(const std::string& archive, const std::string& bag,
                         const std::function<void(const std::string& step, double share)>& progress = {});

}  // namespace fsr_ros
