#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::dataset {

/// Which sensor made a recording; empty strings are unknown.
struct SensorIdentity {
  std::string sensor_id;
  std::string serial;
  std::string firmware;
  std::string model;
  std::string sealing;
  std::string transducer;
};

/// What went missing between the board and the Recording.
struct RecordingLosses {
  std::uint64_t sequence_gaps = 0;    ///< places where the board's scan counter jumped
  std::uint64_t lost_scans = 0;       ///< scans that those jumps skipped
  std::uint64_t duplicates = 0;       ///< scans of one stamp, dropped
  std::uint64_t near_change = 0;      ///< scans within 1 s of a change of surface, dropped
  std::uint64_t no_reference = 0;     ///< scans that no chamber pressure brackets, dropped
  std::uint64_t bad_reference = 0;    ///< chamber pressures that were no number, left out
  std::uint64_t unknown_surface = 0;  ///< scans under no known curvature, dropped
  /// Places where the board's counter runs backwards along the stamps: it started afresh, or stamps ran
  /// backwards.
  std::uint64_t counter_back = 0;
};

/// Scans with their reference, in time order, as every offline part of the package uses them.
/// One value per scan in each vector; arrays of taxels are scan after scan, row-major.
struct Recording {
  std::string name;    ///< base name of the bag, e.g. 1_flat.bag
  std::string sha256;  ///< of the bag's bytes, hexadecimal; empty where it came over topics
  SensorIdentity sensor;
  matrix::Layout layout;
  std::uint16_t full_scale = 0;
  std::vector<std::uint8_t> mask;  ///< 1 = ignore this taxel; empty = none
  /// Surfaces in order of first appearance; one of unknown curvature where none was recorded.
  std::vector<matrix::Surface> conditions;

  std::vector<double> time;           ///< header stamp [s] since `start`
  std::vector<std::uint16_t> counts;  ///< [scans x taxels]
  std::vector<double> pressure;  ///< chamber, gauge, interpolated to the scan [Pa]; empty = none recorded
  std::vector<std::uint32_t> condition;  ///< index into `conditions`
  std::vector<double> temperature;       ///< [degree Celsius], interpolated; empty = none recorded
  std::int64_t start_ns = 0;             ///< header stamp of time 0 [ns]
  RecordingLosses losses;
  std::vector<std::string> warnings;  ///< sentences for the user, e.g. that ambient pressure was assumed

  std::size_t scans() const { return time.size(); }
  const std::uint16_t* scan(std::size_t i) const { return counts.data() + i * layout.size.taxels(); }
};

/// One sentence for each kind of loss that a user should know of.
std::vector<std::string> describeLosses(const RecordingLosses& losses);

}  // namespace fsr::dataset
