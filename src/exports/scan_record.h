#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::exports {

/// One scan with everything that its recording knows of that moment.
struct ScanRecord {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t stamp_ns = 0;  ///< of the scan's header, since 1970 [ns]
  std::int64_t since_ns = 0;  ///< since the recording's first scan [ns]
  matrix::Layout layout;
  std::optional<std::uint32_t> sequence;           ///< the board's scan counter
  std::uint16_t full_scale = 0;                    ///< of the counts; 0 = unknown
  std::vector<std::uint16_t> counts;               ///< [rows x columns], row-major; empty = not recorded
  std::optional<map::PressureMap> map;             ///< none = neither recorded nor computed
  double chamber_pressure = kUnknown;              ///< gauge, interpolated to the scan [Pa]
  double temperature = kUnknown;                   ///< likewise [degree Celsius]
  std::shared_ptr<const matrix::Surface> surface;  ///< that held then; none = never told
  std::string session;                             ///< empty = never told
  std::optional<std::size_t> cycle;                ///< of the chamber's pressure, from 1
  std::optional<std::uint64_t> raw_row;  ///< number of the scan's message among those of its topic in the bag
  std::optional<std::uint64_t> map_row;  ///< likewise of the map's; none = computed, or there is none
  std::string event;                     ///< the last one so far, "kind" or "kind:label"; empty = none
};

/// What stands still while a recording is exported.
struct ExportSubject {
  std::string name;         ///< base name of the bag
  bool maps = false;        ///< whether scans come with pressure maps
  std::string sensor;       ///< id, else serial number; empty = unknown
  std::string model;        ///< of the sensor sheet; empty = unknown
  std::string calibration;  ///< id; empty = none
  std::string scheme;
  double trained_low = ScanRecord::kUnknown;   ///< gauge pressures that the calibration was trained on [Pa]
  double trained_high = ScanRecord::kUnknown;  ///< [Pa]
};

/// Takes a recording's scans in the order of their stamps. Each throws InputError where the output cannot be
/// written; without finish() nothing of it remains.
class ScanSink {
 public:
  virtual ~ScanSink() = default;
  /// Before the first scan of each recording.
  virtual void begin(const ExportSubject& subject) = 0;
  virtual void add(const ScanRecord& scan) = 0;
  virtual void finish() = 0;
};

/// Flags by their names in docs/live.md, e.g. "SATURATED|TARED"; "none" without flags.
std::string flagWords(std::uint16_t flags);

/// "OK", "CURVATURE_UNKNOWN" ...
std::string stateWord(map::MapState state);

}  // namespace fsr::exports
