#pragma once

#include <cstdint>
#include <limits>

namespace fsr::map {

struct PressureMap;
struct Region;

/// The numbers are those of PressureStatistics.msg.
enum class AlarmState : std::uint8_t { kOk = 0, kAlarm = 1, kUnknown = 2 };

/// When a region alarms; the default never does.
struct AlarmOptions {
  double threshold = std::numeric_limits<double>::infinity();  ///< of any taxel [Pa]; infinite = no alarm
  double dwell = 0;       ///< above the threshold for as long before it is an alarm [s]
  double hysteresis = 0;  ///< an alarm ends only this far below the threshold [Pa]

  bool used() const { return threshold < std::numeric_limits<double>::infinity(); }
};

/// What one map says to an alarm.
struct AlarmEvidence {
  /// Highest pressure that is surely there [Pa]: of taxels with a sound reading, and of saturated ones, whose
  /// pressure is at least what they read. NaN = none.
  double sure = std::numeric_limits<double>::quiet_NaN();
  /// Every taxel of the region was read, within what training saw. A taxel under its turn-on pressure counts
  /// as read; a masked one is nobody's question; a filled one is a guess.
  bool whole = false;
  /// Highest pressure of taxels below their range, which bear less than what they read [Pa]; NaN = none.
  double less_than = std::numeric_limits<double>::quiet_NaN();
};

AlarmEvidence evidence(const PressureMap& map, const Region& region);

/// The alarm of one region over time.
///
/// It rises where a pressure that is surely there stays at or above the threshold for the dwell time, and
/// falls only below threshold - hysteresis. Where the map cannot answer (stale, uncalibrated, curvature
/// unknown, extrapolated, saturated or failed taxels, "less than" a pressure above the threshold) the answer
/// is unknown, never OK; an alarm that is sure stays an alarm.
class Alarm {
 public:
  explicit Alarm(const AlarmOptions& options = {}) : options_(options) {}

  /// `time` of the map [s]; time that runs back starts the dwell anew.
  AlarmState update(double time, const AlarmEvidence& evidence);
  /// No map has come for too long.
  AlarmState stale();

 private:
  AlarmOptions options_;
  AlarmState withoutAlarm(const AlarmEvidence& evidence) const;

  bool above_ = false;      // the threshold was passed, and nothing sure fell below it since
  double above_since_ = 0;  // [s]
  bool raised_ = false;
};

}  // namespace fsr::map
