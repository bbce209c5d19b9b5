#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "exports/scan_record.h"

namespace fsr_ros {

/// Which scans of a bag are exported.
struct ScanSelection {
  std::string topics;                ///< namespace of the sensor; empty = the only one
  std::string map = "pressure_map";  ///< topic of the maps, if a bag holds several
  /// Files to compute the maps with: that of the board's serial number, where there are several; empty =
  /// recorded maps.
  std::vector<std::string> calibrations;
  bool several_sheets = false;  ///< in the bag: then a calibration is used for its own board alone
  std::optional<double>
      ambient;      ///< ambient pressure [Pa]; none = that of matrix_info, or 101325 without one
  double from = 0;  ///< start, since the first scan [s]
  double until = std::numeric_limits<double>::infinity();  ///< end, likewise [s]
  double rate = 0;                                         ///< largest rate of scans; 0 = all scans [Hz]
  /// Is called now and then with what is done and its share; none = nobody asks.
  std::function<void(const std::string& step, double share)> progress = {};
};

/// Namespaces of the sheets in a bag: those with scans or maps; only that of `selection` where it names one.
std::vector<std::string> sheetsIn(const std::string& bag, const ScanSelection& selection);

/// Sends a bag's scans to `sink`, each with map, chamber pressure, temperature, surface, session, cycle and
/// last event. Calls begin(), then add() in the order of the stamps, but not finish(). The bag is read twice
/// and never held in memory: memory grows with the chamber pressure and temperature readings (16 bytes each),
/// not with the scans. A scan and a map with the same stamp belong together; they may be up to two seconds
/// apart in the bag. Returns the number of scans sent. Throws fsr::InputError that names the bag.
std::size_t sendScans(const std::string& bag, const ScanSelection& selection, fsr::exports::ScanSink& sink);

}  // namespace fsr_ros
