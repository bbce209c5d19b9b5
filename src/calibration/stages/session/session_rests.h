#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compensation/scheme_plan.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// The scans at the start of a session over which a tare averages, as long as the window of a live tare
/// (TareOptions). `condition`: of the recording; a session is one condition of one recording. Empty = the
/// session does not start with a rest.
///
/// The chamber rests while the medians of its pressure over 0.2 s are near the lowest level that it holds in
/// the session (within 2 kPa or 1 % of the session's range), do not drift by more than 0.5 kPa beyond their
/// noise, and put no load on the sheet (5 kPa or 5 % of the session's highest pressure). Scans with spikes of
/// the reference are left out.
std::vector<std::size_t> restAtStart(const dataset::Recording& recording, std::size_t condition);

/// Why a session does not start with a rest: "it does not start with 2 s at rest: the chamber is at 31.0 kPa,
/// which is a load". Empty = it does.
std::string whyNoRest(const dataset::Recording& recording, std::size_t condition);

/// The first scans of the last rest after a load, found by the same rule. Empty = there is no such rest.
std::vector<std::size_t> restAfterLoad(const dataset::Recording& recording, std::size_t condition);

/// The readings of one taxel at rest that have the same code, below full scale.
struct ReadingAtRest {
  std::uint16_t code = 0;
  double pressure = 0;  ///< of the chamber, mean [Pa]
  double count = 0;
};

/// The readings of one taxel in the scans of a rest.
std::vector<ReadingAtRest> readingsAtRest(const dataset::Recording& recording,
                                          const std::vector<std::size_t>& rest, std::size_t taxel);

/// The rests that one model was trained with: [rests][taxels].
using TrainedRests = std::vector<std::vector<std::vector<ReadingAtRest>>>;

/// The rest at the start of a session.
struct StartRest {
  std::vector<std::size_t> scans;
  std::shared_ptr<const TrainedRests> trained;  ///< of the model that answers; null = not compared with them

  bool empty() const { return scans.empty(); }
};

/// What the table of a taxel answers too much at rest, mean over the readings [Pa]. Nothing where there is no
/// reading or the table is empty. `table`: pressure of each code [Pa].
template <typename Number>
std::optional<double> zeroAtRest(const std::vector<ReadingAtRest>& readings,
                                 const std::vector<Number>& table) {
  if (table.empty() || readings.empty()) return {};
  double sum = 0, count = 0;
  for (const ReadingAtRest& reading : readings) {
    sum += reading.count * (double(table[reading.code]) - reading.pressure);
    count += reading.count;
  }
  return sum / count;
}

/// What the table of a taxel answers too much at the rests of its own training, mean over the rests [Pa]. It
/// is not zero: at the same reading the pressure is higher in other parts of a loop or after creep. 0 where
/// training had no rest.
template <typename Number>
double zeroInTraining(const TrainedRests& rests, std::size_t taxel, const std::vector<Number>& table) {
  double sum = 0, count = 0;
  for (const auto& taxels : rests) {
    const std::optional<double> zero = zeroAtRest(taxels[taxel], table);
    sum += zero.value_or(0);
    count += zero ? 1 : 0;
  }
  return count > 0 ? sum / count : 0.0;
}

/// What a tare subtracts [Pa]: the zero of the rest at the start of a session minus that of the training.
std::optional<double> zeroAtRest(const dataset::Recording& recording, const StartRest& rest,
                                 std::size_t taxel, const std::vector<double>& table);

/// One stay of the sheet: a recording, a surface and a mount.
struct Session {
  std::size_t recording = 0;
  std::size_t condition = 0;  ///< of the recording
  std::size_t curvature_class = 0;
  std::uint32_t number = 0;  ///< among the sessions of its class
  StartRest rest;            ///< empty = the session has no zero

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

/// Gives each rest those of the model that answers in its session.
void referToTraining(const std::vector<dataset::Recording>& recordings, const compensation::SchemePlan& plan,
                     Sessions& sessions);

}  // namespace fsr::calibration
