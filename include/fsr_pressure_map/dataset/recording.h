#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::dataset {

/// The sensor of a recording. An empty string means unknown.
struct SensorIdentity {
  std::string sensor_id;
  std::string serial;
  std::string firmware;
  std::string model;
  std::string sealing;
  std::string transducer;
};

class CountFile;  // dataset/count_file.h

/// What was lost between the board and the Recording.
struct RecordingLosses {
  std::uint64_t sequence_gaps = 0;     ///< places where the board's counter jumped, or no scan came for long
  std::uint64_t lost_scans = 0;        ///< scans that the jumps of the counter skipped
  std::uint64_t duplicates = 0;        ///< scans with the stamp of another one, dropped
  std::uint64_t near_change = 0;       ///< scans within 1 s of a change of surface, dropped
  std::uint64_t no_reference = 0;      ///< scans without a chamber pressure before and after them, dropped
  std::uint64_t bad_reference = 0;     ///< chamber pressures that were not finite, left out
  std::uint64_t reference_spikes = 0;  ///< chamber pressures that the sheet did not feel, left out
  std::uint64_t unknown_surface = 0;   ///< scans on a surface of unknown curvature, dropped
  /// Places where the board's counter decreases along the stamps: the board started again, or stamps ran
  /// backwards.
  std::uint64_t counter_back = 0;
};

/// Scans with their reference pressure, in the order of time: the input of all offline functions. Each vector
/// has one value per scan. Arrays of taxels are stored scan after scan, each row-major.
struct Recording {
  std::string name;    ///< base name of the bag, e.g. 1_flat.bag
  std::string sha256;  ///< of the bag's bytes, hexadecimal; empty for data from topics
  SensorIdentity sensor;
  matrix::Layout layout;
  std::uint16_t full_scale = 0;
  std::vector<std::uint8_t> mask;  ///< 1 = ignore this taxel; empty = none
  /// Surfaces in the order of their first appearance. Where none was recorded: one of unknown curvature.
  std::vector<matrix::Surface> conditions;

  std::vector<double> time;           ///< header stamp [s] since `start`
  std::vector<std::uint16_t> counts;  ///< [scans x taxels]; empty where they are in `count_file`
  /// The counts of a long recording, where its reader was asked to keep them in a file; else null.
  std::shared_ptr<const CountFile> count_file;
  std::vector<double>
      pressure;  ///< gauge pressure of the chamber, interpolated to the scan [Pa]; empty = none recorded
  double reference_interval = 0;         ///< median time between readings of that pressure [s]; 0 = not known
  double reference_error = 0;            ///< estimated rms error of that interpolation [Pa]
  std::vector<std::uint32_t> condition;  ///< index into `conditions`
  std::vector<double> temperature;       ///< [degree Celsius], interpolated; empty = none recorded
  std::int64_t start_ns = 0;             ///< header stamp of time 0 [ns]
  RecordingLosses losses;
  std::vector<std::string> warnings;  ///< sentences for the user, e.g. that ambient pressure was assumed

  std::size_t scans() const { return time.size(); }
  /// The counts of a scan that are in memory.
  const std::uint16_t* scan(std::size_t i) const { return counts.data() + i * layout.size.taxels(); }
};

/// One sentence for each kind of loss that the user should know.
std::vector<std::string> describeLosses(const RecordingLosses& losses);

}  // namespace fsr::dataset
