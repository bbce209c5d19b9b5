#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::map {

struct PressureMap;

/// The numbers are those of PressureStatistics.msg. kNotSet: the region has no threshold.
enum class AlarmState : std::uint8_t { kOk = 0, kAlarm = 1, kUnknown = 2, kNotSet = 3 };

/// Conditions of an alarm. The default never alarms.
struct AlarmOptions {
  double threshold =
      std::numeric_limits<double>::infinity();  ///< pressure of any taxel [Pa]; infinite = no alarm
  double dwell = 0;                             ///< time above the threshold before the alarm is raised [s]
  double hysteresis = 0;  ///< an alarm ends only at this pressure below the threshold [Pa]

  bool used() const { return threshold < std::numeric_limits<double>::infinity(); }
};

/// Name of the whole matrix in tables and topics.
constexpr char kWholeMatrix[] = "whole_matrix";

/// A named part of the matrix, with its alarm.
struct Region {
  std::string name;  ///< "" = the whole matrix, kWholeMatrix where no name may be empty
  std::vector<std::uint8_t>
      mask;  ///< [rows x columns], row-major, 1 = part of the region; empty = every taxel
  AlarmOptions alarm;

  bool has(std::size_t taxel) const { return mask.empty() || mask[taxel] != 0; }
};

/// Reads a region file. A region is a rectangle, or a mask with one line for each row:
///
///     unit: Pa               # of thresholds and hysteresis, optional: Pa, kPa or mmHg
///     alarm: {threshold: 250e3, dwell: 1.0, hysteresis: 20e3}   # of the whole matrix, optional [Pa, s, Pa]
///     regions:
///       - name: patellar_tendon
///         rows: [0, 2]         # first and last, counted from 0
///         columns: [3, 6]
///       - name: fibula_head
///         mask: |              # 1 = part of the region, 0 or . = not
///           0011000000
///           0111000000
///         alarm: {threshold: 120e3, dwell: 2.0}
///
/// The first region of the result is the whole matrix, with the name "". Throws InputError.
std::vector<Region> readRegionFile(const std::string& path, matrix::MatrixSize size);
/// Reads the same from text. `origin`: name that messages give instead of a file.
std::vector<Region> readRegions(const std::string& yaml, const std::string& origin, matrix::MatrixSize size);
/// The names in a region file, "" first, whatever the size of the matrix. Throws InputError.
std::vector<std::string> regionNames(const std::string& path);

/// What one map shows of an alarm's region.
struct AlarmEvidence {
  /// Highest pressure that is certain [Pa]: of taxels with a valid reading, and of those whose pressure is at
  /// least their reading (isLowerLimit). NaN = none.
  double sure = std::numeric_limits<double>::quiet_NaN();
  /// Whether every taxel of the region has a reading within the range of training. A taxel below its turn-on
  /// pressure counts as read, a masked one is ignored, a filled one does not count as read.
  bool whole = false;
  /// Highest reading of taxels below their range, whose pressure is less than their reading [Pa]; NaN = none.
  double less_than = std::numeric_limits<double>::quiet_NaN();
};

AlarmEvidence evidence(const PressureMap& map, const Region& region);

/// The alarm of one region over time.
///
/// It is raised where a certain pressure stays at or above the threshold for the dwell time, and ends only
/// below threshold - hysteresis. Where the map cannot answer (stale, uncalibrated, curvature unknown,
/// extrapolated, saturated or failed taxels, "less than" a pressure above the threshold) the state is
/// kUnknown, never kOk. An alarm that is certain stays an alarm: a reading above training, or at full scale,
/// is "at least" and holds it. Without a threshold the state is kNotSet, never kOk.
class Alarm {
 public:
  explicit Alarm(const AlarmOptions& options = {}) : options_(options) {}

  /// `time` of the map [s]. Time that runs backwards restarts the dwell.
  AlarmState update(double time, const AlarmEvidence& evidence);
  /// The state where no map has come for too long.
  AlarmState stale();

 private:
  AlarmOptions options_;
  AlarmState withoutAlarm(const AlarmEvidence& evidence) const;

  bool above_ = false;      // the threshold was reached, and no certain pressure was below it since
  double above_since_ = 0;  // [s]
  bool raised_ = false;
};

}  // namespace fsr::map
