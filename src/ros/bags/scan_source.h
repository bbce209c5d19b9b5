#pragma once

#include <limits>
#include <optional>
#include <string>

#include "exports/scan_record.h"

namespace fsr_ros {

/// What of a bag is exported as scans; every default stands here.
struct ScanSelection {
  std::string topics;                ///< namespace of the sensor; empty = the only one
  std::string map = "pressure_map";  ///< topic of the maps, where a bag holds several
  std::string calibration;           ///< file that maps are computed with; empty = as recorded
  std::optional<double> ambient;     ///< ambient pressure [Pa]; none = what matrix_info says, else 101325
  double from = 0;                   ///< since the first scan [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
  double rate = 0;     ///< at most as many scans a second; 0 = every one [Hz]
  bool counts = true;  ///< false: leave `raw` aside where maps are recorded
};

/// Sends a bag's scans to `sink`, each with map, chamber pressure, temperature, surface, session, cycle and
/// last event: begin(), then add() in the order of the stamps; not finish(). The bag is read twice and never
/// held: memory grows with chamber pressure and temperature (16 bytes a reading), not with scans. Scan and
/// map belong together by their stamp; they may lie up to two seconds apart in the bag. Returns how many
/// scans were sent. Throws fsr::InputError that names the bag.
std::size_t sendScans(const std::string& bag, const ScanSelection& selection, fsr::exports::ScanSink& sink);

}  // namespace fsr_ros
