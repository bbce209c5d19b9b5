#include "session/plan_steps.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>

#include "settings/number_text.h"
#include "simulation/pressure_profile.h"
#include "statistics/random_stream.h"

namespace fsr::session {

namespace {

using settings::roundedText;

simulation::ChamberProtocol conditioningCycle(const SessionPlan& plan) {
  const Conditioning& c = plan.conditioning;
  return {conditioningPeak(plan), c.rate, c.rate, c.dwell_peak, c.dwell_rest, 1};
}

double conditioningDuration(const SessionPlan& plan) {
  return plan.conditioning.cycles * simulation::cycleDuration(conditioningCycle(plan));
}

// Rest, program, rest: what is recorded of each mount.
simulation::ChamberProgram recordedProgram(const SessionPlan& plan) {
  simulation::ChamberProgram program;
  if (plan.rest.before > 0) program.emplace_back(simulation::RestPart{17e3, plan.rest.before});
  program.insert(program.end(), plan.program.begin(), plan.program.end());
  program.emplace_back(simulation::RestPart{17e3, plan.rest.after});
  return program;
}

// Puts the members behind the first `fixed` in a random order: Fisher and Yates. `drawn`: how many numbers of
// the stream are used up.
void shuffle(std::vector<std::size_t>& members, std::size_t fixed, const statistics::RandomStream& stream,
             std::uint64_t& drawn) {
  for (std::size_t left = members.size(); left > fixed + 1; --left)
    std::swap(members[left - 1], members[fixed + stream.bits(drawn++) % (left - fixed)]);
}

// Appends the steps of one mount. Called by std::visit for the parts of the program.
class MountSteps {
 public:
  MountSteps(const SessionPlan& plan, const PlannedMount& mount, std::vector<SessionStep>& steps)
      : plan_(plan), mount_(mount), steps_(steps), first_(steps.size()) {}

  void run(bool conditioned) {
    append(StepKind::kMount, plan_.change, false, {0, 0, 0, 0, 0, 0});
    const simulation::ChamberProtocol cycle = conditioningCycle(plan_);
    for (unsigned c = 0; conditioned && c < plan_.conditioning.cycles; ++c)
      append(StepKind::kCondition, simulation::cycleDuration(cycle), false, cycle);
    for (const simulation::ProgramPart& part : recordedProgram(plan_)) std::visit(*this, part);
    for (const Break& one : plan_.breaks) {
      if (one.after == mount_.number)
        append(StepKind::kBreak, one.duration, false, {0, 0, 0, 0, one.duration, 1});
    }
    count();
  }

  void operator()(const simulation::ChamberProtocol& part) {
    for (unsigned c = 0; c < part.cycles; ++c)
      append(StepKind::kCycle, rampTo(0, part.vent_rate) + simulation::cycleDuration(part), true, part);
  }
  void operator()(const simulation::HoldPart& part) {
    append(StepKind::kHold, rampTo(part.pressure, part.rate) + part.duration, true,
           {part.pressure, part.rate, part.rate, part.duration, 0, 1});
  }
  void operator()(const simulation::LoopsPart& part) {
    const double ramps = 2 * (part.high - part.low) / part.rate;
    for (unsigned l = 0; l < part.loops; ++l)
      append(StepKind::kLoop, rampTo(part.low, part.rate) + ramps, true,
             {part.high, part.rate, part.rate, 0, 0, 1})
          .low = part.low;
  }
  void operator()(const simulation::RestPart& part) {
    const double duration = rampTo(0, part.rate) + part.duration;
    if (duration > 0) append(StepKind::kRest, duration, true, {0, 0, part.rate, 0, part.duration, 1});
  }

 private:
  // `course`: what the chamber does; a number that the kind does not have is 0.
  SessionStep& append(StepKind kind, double duration, bool recorded,
                      const simulation::ChamberProtocol& course) {
    SessionStep step;
    step.kind = kind;
    step.mount = mount_.number;
    step.surface = plan_.surfaces[mount_.surface].surface.name;
    step.recorded = recorded;
    step.begin = steps_.empty() ? 0 : steps_.back().begin + steps_.back().duration;
    step.duration = duration;
    step.peak = course.peak;
    step.fill_rate = course.fill_rate;
    step.vent_rate = course.vent_rate;
    step.dwell_peak = course.dwell_peak;
    step.dwell_rest = course.dwell_rest;
    steps_.push_back(step);
    return steps_.back();
  }
  // Time to reach a pressure [s].
  double rampTo(double pressure, double rate) {
    const double time = std::abs(pressure - pressure_) / rate;
    pressure_ = pressure;
    return time;
  }
  // Numbers the steps of each kind, and sets what may differ.
  void count() {
    for (std::size_t s = first_; s < steps_.size(); ++s) {
      SessionStep& step = steps_[s];
      const auto same = [&](const SessionStep& other) { return other.kind == step.kind; };
      const auto at = [&](std::size_t i) { return steps_.begin() + static_cast<std::ptrdiff_t>(i); };
      step.number = static_cast<unsigned>(std::count_if(at(first_), at(s + 1), same));
      step.of = static_cast<unsigned>(std::count_if(at(first_), steps_.end(), same));
      step.peak_error = plan_.tolerance.peak * step.peak;
      step.rate_error = plan_.tolerance.rate;
      step.dwell_error = plan_.tolerance.dwell;
    }
  }

  const SessionPlan& plan_;
  const PlannedMount& mount_;
  std::vector<SessionStep>& steps_;
  std::size_t first_;
  double pressure_ = 0;  // where the chamber stands [Pa]
};

std::string rate(double rate) {
  return roundedText(rate / 1e3, 3) + " kPa/s";
}

std::string seconds(double time) {
  return roundedText(time, 4) + " s";
}

std::string countText(const SessionStep& step) {
  return std::to_string(step.number) + " of " + std::to_string(step.of) + ": ";
}

std::string fillAndVent(const SessionStep& step) {
  return countText(step) + "fill to " + settings::roundedPressure(step.peak, 4) + " at " +
         rate(step.fill_rate) + ", hold for " + seconds(step.dwell_peak) + ", vent at " +
         rate(step.vent_rate) + ".";
}

}  // namespace

std::vector<PlannedMount> mountOrder(const SessionPlan& plan) {
  const statistics::RandomStream stream = statistics::randomStream(plan.seed, "session_plan.order");
  std::uint64_t drawn = 0;
  unsigned rounds = 0;
  for (const PlannedSurface& surface : plan.surfaces) rounds = std::max(rounds, surface.mounts);
  std::vector<std::size_t> order;
  for (unsigned round = 1; round <= rounds; ++round) {
    std::vector<std::size_t> members;
    for (std::size_t s = 0; s < plan.surfaces.size(); ++s) {
      if (plan.surfaces[s].mounts >= round) members.push_back(s);
    }
    if (plan.drawn_order) shuffle(members, round == 1 ? 1 : 0, stream, drawn);
    if (plan.drawn_order && !order.empty() && members.size() > 1 && members.front() == order.back())
      std::swap(members.front(), members.back());
    order.insert(order.end(), members.begin(), members.end());
  }
  if (plan.repeat_first) {
    // If the last surface is the first one, it changes places with the one before it.
    const std::size_t n = order.size();
    if (plan.drawn_order && n > 3 && order[n - 1] == order.front() && order[n - 3] != order[n - 1])
      std::swap(order[n - 1], order[n - 2]);
    order.push_back(order.front());
  }
  std::vector<PlannedMount> mounts;
  for (const std::size_t s : order) mounts.push_back({static_cast<unsigned>(mounts.size() + 1), s});
  return mounts;
}

std::string name(StepKind kind) {
  static const char* const kNames[] = {"condition", "mount", "rest",  "cycle",
                                       "loop",      "hold",  "break", "done"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<SessionStep> sessionSteps(const SessionPlan& plan) {
  std::vector<SessionStep> steps;
  for (const PlannedMount& mount : mountOrder(plan)) MountSteps(plan, mount, steps).run(mount.number == 1);
  return steps;
}

std::string instruction(const SessionStep& step) {
  switch (step.kind) {
    case StepKind::kMount:
      return "Put the sheet on " + step.surface + ", mount " + std::to_string(step.mount) + ".";
    case StepKind::kCondition:
      return "Conditioning " + fillAndVent(step);
    case StepKind::kRest:
      return "Vent, and leave the sheet without load for " + seconds(step.dwell_rest) + ".";
    case StepKind::kCycle:
      return "Cycle " + fillAndVent(step);
    case StepKind::kHold:
      return "Hold " + countText(step) + "go to " + settings::roundedPressure(step.peak, 4) + " at " +
             rate(step.fill_rate) + " and stay for " + seconds(step.dwell_peak) + ".";
    case StepKind::kLoop:
      return "Partial loop " + countText(step) + "from " + settings::roundedPressure(step.low, 4) + " to " +
             settings::roundedPressure(step.peak, 4) + " and back at " + rate(step.fill_rate) + ".";
    case StepKind::kBreak:
      return "Break of " + roundedText(step.dwell_rest / 60, 3) + " min without load.";
    case StepKind::kDone:
      break;
  }
  return "";
}

double sessionDuration(const SessionPlan& plan) {
  const auto mounts = static_cast<double>(mountsOf(plan));
  double duration = conditioningDuration(plan) + mounts * (plan.change + recordingDuration(plan));
  for (const Break& one : plan.breaks) duration += one.duration;
  return duration;
}

double recordingDuration(const SessionPlan& plan) {
  return simulation::pressureProfile(recordedProgram(plan)).duration();
}

std::vector<simulation::Station> simulatedStations(const SessionPlan& plan) {
  std::vector<simulation::Station> stations;
  for (const PlannedMount& mount : mountOrder(plan)) {
    simulation::Station station;
    station.surface = plan.surfaces[mount.surface].surface;
    station.surface.mount = mount.number;
    station.pause = plan.change + (mount.number == 1 ? conditioningDuration(plan) : 0);
    for (const Break& one : plan.breaks) station.pause += one.after + 1 == mount.number ? one.duration : 0;
    station.program = recordedProgram(plan);
    stations.push_back(std::move(station));
  }
  return stations;
}

}  // namespace fsr::session
