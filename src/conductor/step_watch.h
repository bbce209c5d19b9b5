#pragma once

#include <memory>
#include <optional>
#include <string>

#include "conductor/verdict.h"
#include "dataset/unsound/unsound_spans.h"
#include "session_plan/steps.h"

namespace fsr::conductor {

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

/// What hinders a step just now.
struct Hint {
  Reason reason = Reason::kNone;
  std::string sentence;
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
  /// What hinders the attempt just now.
  virtual Hint hint() const { return {}; }
};

/// The watch of a step from `begin` [s] on. `after_loop`: the step before it was a partial loop that was
/// accepted. None for the step kMount, which a person confirms.
std::unique_ptr<StepWatch> watchOf(const session_plan::SessionStep& step, double begin, bool after_loop);

/// Whether a new attempt can begin after one was rejected: the pressure is down again.
bool canBegin(const session_plan::SessionStep& step, double pressure);

// ---- for the watches -------------------------------------------------------------------------------

std::string kPaText(double pressure);
std::string rateText(double rate);
std::string timeText(double time);
/// "" or what is wrong with a rate, with its reason.
Hint judgeRate(const session_plan::SessionStep& step, double rate, bool filling);

std::unique_ptr<StepWatch> excursionWatch(const session_plan::SessionStep& step, bool after_loop);
std::unique_ptr<StepWatch> holdWatch(const session_plan::SessionStep& step);
std::unique_ptr<StepWatch> restWatch(const session_plan::SessionStep& step, double begin);

}  // namespace fsr::conductor
