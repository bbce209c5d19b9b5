#pragma once

#include <string>

#include "dataset/recording_builder.h"

namespace fsr_ros {

struct BagReadOptions {
  /// Namespace of the sensor's topics, e.g. "fsr" or "/left/fsr"; empty = the only one in the bag with a
  /// topic `raw`.
  std::string topics;
  /// Name and hash are filled in from the file.
  fsr::dataset::RecordingOptions recording;
};

/// The recording of one sensor in a bag: topics raw, chamber_pressure, curvature, temperature and
/// matrix_info under one namespace, of which only raw must be there. Throws fsr::InputError, one
/// sentence that names the file and what would be right: no such file, no bag, not indexed, cut short,
/// no topic raw, several sensors, a topic of another type, messages that do not fit each other.
fsr::dataset::Recording readBag(const std::string& path, const BagReadOptions& options = {});

}  // namespace fsr_ros
