#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// The scans at the start of a session over which a tare averages: the chamber pressure is still at the
/// lowest of the session. They last as long as the window of a live tare (TareOptions). Empty = the session
/// does not start with a rest. `condition`: of the recording; a session is one condition of one recording.
std::vector<std::size_t> restAtStart(const dataset::Recording& recording, std::size_t condition);

/// The first scans of the last rest after a load, which last at most as long as those of restAtStart(). Empty
/// = there is no such rest.
std::vector<std::size_t> restAfterLoad(const dataset::Recording& recording, std::size_t condition);

/// A reading of one taxel at rest, below full scale.
struct ReadingAtRest {
  std::uint16_t code = 0;
  double pressure = 0;  ///< of the chamber [Pa]
};

/// The readings of one taxel in the scans of a rest.
std::vector<ReadingAtRest> readingsAtRest(const dataset::Recording& recording,
                                          const std::vector<std::size_t>& rest, std::size_t taxel);

/// What the table of a taxel answers too much at rest, mean over the readings [Pa]. Nothing where there is no
/// reading or the table is empty. `table`: pressure of each code [Pa].
std::optional<double> zeroAtRest(const std::vector<ReadingAtRest>& readings,
                                 const std::vector<double>& table);
/// The same of the readings in the scans of a rest.
std::optional<double> zeroAtRest(const dataset::Recording& recording, const std::vector<std::size_t>& rest,
                                 std::size_t taxel, const std::vector<double>& table);

/// One stay of the sheet: a recording, a surface and a mount.
struct Session {
  std::size_t recording = 0;
  std::size_t condition = 0;  ///< of the recording
  std::size_t curvature_class = 0;
  std::uint32_t number = 0;       ///< among the sessions of its class
  std::vector<std::size_t> rest;  ///< scans; empty = the session has no zero

  /// "a.bag, flat, mount 2".
  std::string name(const std::vector<dataset::Recording>& recordings) const;
};

/// The sessions of all recordings. Within a class those that start with a rest have the lowest numbers.
struct Sessions {
  std::vector<Session> all;
  std::size_t most = 0;            ///< largest number of sessions of a class
  std::vector<std::size_t> rests;  ///< [classes], number of sessions that start with a rest

  /// Whether the session can be left out: it has a zero, and so has another session of its class.
  bool assessable(const Session& session) const {
    return !session.rest.empty() && rests[session.curvature_class] > 1;
  }
  bool assessable() const;
};

Sessions findSessions(const std::vector<dataset::Recording>& recordings,
                      const dataset::ConditionClasses& classes);

}  // namespace fsr::calibration
