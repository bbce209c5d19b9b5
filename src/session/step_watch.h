#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "dataset/unsound_spans.h"
#include "session/plan_steps.h"

namespace fsr::session {

/// Why a step was rejected, or what hinders it. It stands where the readers of bags find it, too.
using Reason = dataset::RejectReason;

/// What was measured of one attempt. NaN = the step has no such thing, or it was not reached.
struct Measured {
  double peak = std::numeric_limits<double>::quiet_NaN();       ///< highest pressure, gauge [Pa]
  double fill_rate = std::numeric_limits<double>::quiet_NaN();  ///< from 10 % to 90 % of the step [Pa/s]
  double vent_rate = std::numeric_limits<double>::quiet_NaN();  ///< from 90 % to 10 % [Pa/s]
  double dwell = std::numeric_limits<double>::quiet_NaN();      ///< at the peak, without the ramps [s]
  double rest = std::numeric_limits<double>::quiet_NaN();       ///< without load before it [s]
};

/// Accepted, or rejected for a reason.
struct Verdict {
  Reason reason = Reason::kNone;
  std::string sentence;  ///< for a person: what is wrong, with the measured and the planned value
  Measured measured;

  bool accepted() const { return reason == Reason::kNone; }
};

/// A reading of the chamber's transducer.
struct Reading {
  double time = 0;      ///< [s]
  double pressure = 0;  ///< gauge [Pa]
};

/// The chamber is at rest up to the first gauge pressure, and loaded from the second one on [Pa].
constexpr double kRestLevel = dataset::kRestLevel;
constexpr double kLoadLevel = 2 * kRestLevel;

/// Since when the chamber has been without load, over all steps.
class RestClock {
 public:
  /// Takes a reading. Between rest and load the clock runs on.
  void take(const Reading& reading);
  void restart() { *this = {}; }

  bool resting() const { return since_.has_value(); }
  std::optional<double> since() const { return since_; }  ///< [s]; none under load
  /// Length of the last or present rest, to the last reading at rest [s].
  double length() const { return begin_ ? last_ - *begin_ : 0; }
  /// Length of its part behind `time` [s].
  double lengthSince(double time) const { return begin_ ? last_ - std::max(*begin_, time) : 0; }

 private:
  std::optional<double> since_;  // of the present rest
  std::optional<double> begin_;  // of the last one
  double last_ = 0;              // last reading at rest
};

/// Recognises one attempt at a step in the course of the pressure. Memory does not grow with time.
class StepWatch {
 public:
  virtual ~StepWatch() = default;
  /// Takes the next reading; `rest` has taken it already. A verdict ends the attempt, and the watch is not
  /// used any more.
  virtual std::optional<Verdict> take(const Reading& reading, const RestClock& rest) = 0;
  /// Whether the attempt has begun, so that it can be spoilt.
  virtual bool running() const = 0;
  /// What hinders the attempt just now; accepted = nothing.
  virtual Verdict hint() const { return {}; }
};

/// The watch of a step from `begin` [s] on. `after_loop`: the step before it was a partial loop that was
/// accepted. None for the step kMount, which a person confirms.
std::unique_ptr<StepWatch> watchOf(const SessionStep& step, double begin, bool after_loop);

/// Whether a new attempt can begin after one was rejected: the pressure is down again.
bool canBegin(const SessionStep& step, double pressure);

std::string kPaText(double pressure);
std::string secondsText(double time);

}  // namespace fsr::session
