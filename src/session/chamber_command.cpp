#include "session/chamber_command.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fsr::session {

namespace {

constexpr double kUnplannedVentRate = 17e3;  // where the step has no pace [Pa/s]

}  // namespace

double ChamberCommand::next(const Conductor& conductor, double time) {
  const auto& complaints = conductor.complaints();
  const bool unsafe = complaints.count(Reason::kPressureLost) + complaints.count(Reason::kPressureInvalid) +
                          complaints.count(Reason::kPressureNotFollowed) +
                          complaints.count(Reason::kAboveLimit) >
                      0;
  const SessionStep* step = conductor.step();
  const bool act = step != nullptr && !unsafe && !conductor.recovering() && !conductor.waitsForMount();
  const Key key{step == nullptr ? 0 : static_cast<std::size_t>(step - conductor.steps().data()), act,
                conductor.revision()};
  if (key != key_) {
    key_ = key;
    begin_ = time;
    plan(act ? step : nullptr);
  }
  set_ = profile_.at(time - begin_);
  return set_;
}

// Null = vent.
void ChamberCommand::plan(const SessionStep* step) {
  std::vector<simulation::PressurePoint> course = {{0, set_}};
  const auto stay = [&course](double time) {
    course.push_back({course.back().time + time, course.back().pressure});
  };
  const auto rampTo = [&course](double pressure, double rate) {
    const simulation::PressurePoint& last = course.back();
    course.push_back({last.time + std::abs(pressure - last.pressure) / rate, pressure});
  };
  const double vent = step != nullptr && step->vent_rate > 0 ? step->vent_rate : kUnplannedVentRate;
  if (step == nullptr || step->kind == StepKind::kRest || step->kind == StepKind::kBreak) {
    rampTo(0, vent);
  } else if (step->kind == StepKind::kHold) {
    rampTo(step->peak, step->fill_rate);
  } else if (step->kind == StepKind::kLoop) {
    for (const double pressure : {step->low, step->peak, step->low}) rampTo(pressure, step->fill_rate);
  } else {
    rampTo(0, vent);
    stay(step->dwell_rest);
    rampTo(step->peak, step->fill_rate);
    stay(step->dwell_peak);
    rampTo(0, vent);
  }
  stay(1);
  profile_ = {};
  profile_.append(course);
}

}  // namespace fsr::session
