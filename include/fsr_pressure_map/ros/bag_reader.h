#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr_ros {

/// How a bag is read.
struct BagReadOptions {
  /// Namespace of the sensor's topics, e.g. "fsr" or "/left/fsr"; empty = the only one in the bag with a
  /// topic `raw`.
  std::string topics;
  /// Ambient pressure [Pa]; none = the value in matrix_info, or 101325 with a warning if there is none.
  std::optional<double> ambient_pressure;
  /// Scans within this time before or after a change of surface are dropped [s].
  double change_margin = 1.0;
  /// From so many bytes on, the counts of the bag are kept in a file without a name in TMPDIR (else
  /// /var/tmp), Recording::count_file; less are in memory.
  std::size_t counts_in_memory = std::numeric_limits<std::size_t>::max();
  /// Is called now and then with the share of the bag that was read; none = nobody asks.
  std::function<void(double share)> progress = {};
};

/// Reads the recording of one sensor from a bag: the topics raw, chamber_pressure, curvature, temperature,
/// matrix_info and events in one namespace. Only raw is required. Throws fsr::settings::InputError, one
/// sentence that names the file and what would be right, if the file does not exist, is not a bag, has no
/// index or is cut short, if the topic raw is missing or there are several sensors, if a topic has another
/// type, or if the messages do not fit each other.
fsr::dataset::Recording readBag(const std::string& path, const BagReadOptions& options = {});

}  // namespace fsr_ros
