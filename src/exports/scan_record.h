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

/// The shortest text that reads back as the same number, in any locale; "NA" for NaN.
std::string exactText(float value);
std::string exactText(double value);

/// Date and time of a stamp in UTC, in a format of strftime().
std::string dateText(std::int64_t stamp_ns, const char* format);

/// Nanoseconds as seconds with nine decimals, exactly: "12.345678900".
std::string secondsText(std::int64_t nanoseconds);

/// One scan with all values of its recording at that time.
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
  double temperature = kUnknown;                   ///< interpolated to the scan [degree Celsius]
  std::shared_ptr<const matrix::Surface> surface;  ///< surface at the time of the scan; none = unknown
  std::string session;                             ///< empty = unknown
  std::optional<std::size_t> cycle;                ///< cycle of the chamber's pressure, from 1
  std::string event;  ///< last event before the scan, "kind" or "kind:label"; empty = none
};

/// Properties of a recording that do not change during its export.
struct ExportSubject {
  std::string name;         ///< base name of the bag
  std::string sheet;        ///< its namespace in the bag; empty = the only one
  bool maps = false;        ///< whether scans come with pressure maps
  std::string sensor;       ///< id, else serial number; empty = unknown
  std::string model;        ///< of the sensor sheet; empty = unknown
  std::string calibration;  ///< id; empty = none
  std::string scheme;
  double trained_low = ScanRecord::kUnknown;   ///< lowest gauge pressure of the training [Pa]
  double trained_high = ScanRecord::kUnknown;  ///< highest gauge pressure of the training [Pa]
};

/// Throws InputError where a scan has another size than the first. `holds`: "datasets have", "a file has" ...
void requireOneSize(const ExportSubject& subject, matrix::MatrixSize first, matrix::MatrixSize now,
                    const std::string& holds);

/// Writes the scans of recordings, in the order of their stamps. Each function throws InputError if the
/// output cannot be written. Without finish() no output remains.
class ScanSink {
 public:
  virtual ~ScanSink() = default;
  /// Called before the first scan of each recording.
  virtual void begin(const ExportSubject& subject) = 0;
  virtual void add(const ScanRecord& scan) = 0;
  virtual void finish() = 0;
};

/// The names of the flags as in PressureMap.msg, e.g. "SATURATED|TARED"; "none" if no flag is set.
std::string flagWords(std::uint16_t flags);

/// The name of a state as in PressureMap.msg: "OK", "CURVATURE_UNKNOWN" ...
std::string stateWord(map::MapState state);

}  // namespace fsr::exports
