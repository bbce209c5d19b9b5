#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "session/conductor.h"
#include "session/example_plans.h"

namespace rig_day {

using example_plans::planFrom;
using example_plans::shipped;

/// One surface, two cycles of 600 kPa with a dwell of 10 s, and nothing else.
constexpr char kCycles[] =
    "plan: small\n"
    "repeat_first: false\n"
    "conditioning: {cycles: 0}\n"
    "rest: {before: 0, after: 0}\n"
    "surfaces: [{surface: flat}]\n"
    "program: [{cycles: {peak: 600000, fill_rate: 20000, vent_rate: 20000, dwell_peak: 10, dwell_rest: 10, "
    "cycles: 2}}]\n";

/// A chamber and a board in the hands of somebody who does what a test says: ten readings and scans a second.
class RigDay {
 public:
  explicit RigDay(const fsr::session::SessionPlan& plan) : conductor(plan) {}
  explicit RigDay(fsr::session::Conductor&& other, double time) : conductor(std::move(other)), now(time) {}

  void stay(double duration) {
    for (double left = duration; left > 1e-9; left -= kPeriod) step(pressure);
  }
  void ramp(double to, double rate) {
    const double from = pressure, length = std::abs(to - from) / rate, begin = now;
    while (now - begin < length - kPeriod / 2)
      step(from + (to - from) * std::min(1.0, (now + kPeriod - begin) / length));
    step(to);
  }
  void cycle(double peak, double fill, double dwell, double vent, double rest) {
    stay(rest);
    ramp(peak, fill);
    stay(dwell);
    ramp(0, vent);
    stay(0.5);
  }
  /// Without mistakes, as the instruction says.
  void follow() {
    const fsr::session::SessionStep step = *conductor.step();
    switch (step.kind) {
      case fsr::session::StepKind::kMount:
        stay(1);
        conductor.confirm();
        break;
      case fsr::session::StepKind::kRest:
      case fsr::session::StepKind::kBreak:
        if (pressure > 0) ramp(0, step.vent_rate > 0 ? step.vent_rate : 17e3);
        stay(step.dwell_rest + 0.5);
        break;
      case fsr::session::StepKind::kHold:
        ramp(step.peak, step.fill_rate);
        stay(step.dwell_peak + 0.5);
        break;
      case fsr::session::StepKind::kLoop:
        ramp(step.low, step.fill_rate);
        ramp(step.peak, step.fill_rate);
        ramp(step.low, step.fill_rate);
        stay(0.3);
        break;
      default:
        if (pressure > 0) ramp(0, step.vent_rate);
        cycle(step.peak, step.fill_rate, step.dwell_peak, step.vent_rate, step.dwell_rest);
    }
  }
  /// The reasons of all rejections since the last call.
  std::vector<std::string> rejected() {
    std::vector<std::string> names;
    for (const fsr::session::Outcome& outcome : conductor.takeOutcomes()) {
      last = outcome.verdict;
      if (outcome.state == fsr::session::StepState::kOpen) names.push_back(name(outcome.verdict.reason));
    }
    return names;
  }
  std::string remark() const { return conductor.instruction().remark; }

  static constexpr double kPeriod = 0.1;  // [s]
  fsr::session::Conductor conductor;
  double now = 1000;    // [s]
  double pressure = 0;  // gauge [Pa]
  bool transducer = true, board = true;
  bool plugged = true;        // false: the transducer reads `unplugged`
  double unplugged = 0;       // gauge [Pa]
  double counts_per_kpa = 0;  // of the taxels; 0 = the conductor gets no counts
  unsigned lost = 0, dead = 0, saturated = 0;
  double offset = 0;           // of the transducer [Pa]
  fsr::session::Verdict last;  // of the last outcome that rejected() saw

 private:
  void step(double to) {
    pressure = to;
    now += kPeriod;
    ++count_;
    const double noise =
        300.0 * (static_cast<double>((count_ * 7919) % 13) - 6.0) / 6.0;  // up to 300 Pa either way
    if (transducer) conductor.pressure(now, (plugged ? pressure + offset : unplugged) + noise);
    std::vector<std::uint16_t> counts(70);
    for (std::size_t t = 0; t < counts.size(); ++t) {
      const double level = counts_per_kpa * pressure / 1e3 * (1 + 0.001 * static_cast<double>(t));
      counts[t] = static_cast<std::uint16_t>(20 + level + static_cast<double>((count_ * 31 + 7 * t) % 5));
    }
    if (board)
      conductor.scan(
          {now, lost, 70, saturated, dead, counts_per_kpa > 0 ? counts.data() : nullptr, std::size_t{10}});
    if (count_ % 5 == 0) conductor.tick(now);
  }
  std::size_t count_ = 0;
};

}  // namespace rig_day
