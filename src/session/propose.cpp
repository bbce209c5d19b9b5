#include "session/propose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "fsr_pressure_map/settings/input_error.h"
#include "session/losses.h"
#include "session/plan_steps.h"
#include "settings/number_text.h"

namespace fsr::session {

namespace {

using settings::roundedText;
using simulation::ChamberProtocol;

constexpr double kFullPeak = 620e3;  // of the programs below; they are scaled to the user's peak [Pa]
constexpr double kBreak = 7200;  // longer than the pause by which `discrepancy` tells clock time from use [s]
constexpr double kHolds[] = {0, 60, 300};            // lengths of the hold [s]
constexpr double kShares[] = {0, 0.3, 0.5, 0.6, 1};  // of the cycles; 0 = one cycle and nothing else

// What a plan is made of. Each lever has a value from 0, the least, to that of the whole plan.
enum Lever : std::size_t { kSurfaces, kMounts, kCycles, kHold, kBreaks, kRepeat, kLevers };
using Extent = std::array<unsigned, kLevers>;

// Cut this lever down to this value.
struct Rung {
  Lever lever;
  unsigned to;
};

struct Recipe {
  Purpose purpose;
  unsigned mounts;  // of each surface
  bool hold, breaks;
  unsigned conditioning;                         // cycles
  std::vector<simulation::ProgramPart> program;  // the hold comes behind it
  std::vector<Rung> ladder;                      // what matters least comes first
};

// Two paces, short and long dwells and partial loops, as `train --history` and `discrepancy` ask for.
std::vector<simulation::ProgramPart> variedProgram() {
  return {ChamberProtocol{kFullPeak, 40e3, 40e3, 1, 1, 3}, ChamberProtocol{kFullPeak, 40e3, 40e3, 10, 10, 2},
          simulation::LoopsPart{200e3, 400e3, 17e3, 2}, simulation::RestPart{17e3, 10},
          ChamberProtocol{kFullPeak, 8e3, 8e3, 10, 10, 1}};
}

Recipe recipeFor(Purpose purpose) {
  switch (purpose) {
    case Purpose::kPerCurvature:
      return {purpose,
              2,
              false,
              false,
              5,
              {ChamberProtocol{kFullPeak, 17e3, 17e3, 1, 1, 10}},
              {{kMounts, 0},
               {kCycles, 2},
               {kSurfaces, 2},
               {kRepeat, 0},
               {kCycles, 1},
               {kSurfaces, 0},
               {kCycles, 0}}};
    case Purpose::kHistory:
      return {purpose,
              1,
              true,
              false,
              5,
              variedProgram(),
              {{kSurfaces, 2},
               {kHold, 1},
               {kSurfaces, 1},
               {kCycles, 1},
               {kRepeat, 0},
               {kSurfaces, 0},
               {kHold, 0},
               {kCycles, 0}}};
    case Purpose::kDiscrepancy:
      return {purpose,
              2,
              true,
              true,
              5,
              variedProgram(),
              {{kBreaks, 0},
               {kSurfaces, 2},
               {kMounts, 0},
               {kHold, 1},
               {kCycles, 1},
               {kSurfaces, 1},
               {kHold, 0},
               {kRepeat, 0},
               {kSurfaces, 0},
               {kCycles, 0}}};
    case Purpose::kFieldCheck:
      break;
  }
  return {
      Purpose::kFieldCheck,
      1,
      false,
      false,
      4,
      {ChamberProtocol{kFullPeak / 2, 17e3, 17e3, 1, 1, 2}, ChamberProtocol{kFullPeak, 17e3, 17e3, 1, 1, 3}},
      {{kSurfaces, 0}, {kCycles, 2}, {kRepeat, 0}, {kCycles, 0}}};
}

// Three significant digits, so that the file can be read.
double rounded(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::round(value / unit) * unit;
}

/// Scales pressures and rates, so that the times stay. Called by std::visit.
struct Scale {
  double by;
  void operator()(ChamberProtocol& part) const {
    part.peak = rounded(part.peak * by);
    part.fill_rate = rounded(part.fill_rate * by);
    part.vent_rate = rounded(part.vent_rate * by);
  }
  void operator()(simulation::HoldPart& part) const {
    part.pressure = rounded(part.pressure * by);
    part.rate = rounded(part.rate * by);
  }
  void operator()(simulation::LoopsPart& part) const {
    part.low = rounded(part.low * by);
    part.high = rounded(part.high * by);
    part.rate = rounded(part.rate * by);
  }
  void operator()(simulation::RestPart& part) const { part.rate = rounded(part.rate * by); }
};

// Surfaces in the order in which they matter: the least and the most bent one, then always the one in the
// middle of the widest gap. The flat surface, if there is one, comes first, since every sheet is used flat.
std::vector<std::size_t> byImportance(const std::vector<matrix::Surface>& surfaces) {
  std::vector<std::size_t> order, left;
  for (std::size_t s = 0; s < surfaces.size(); ++s) left.push_back(s);
  const auto take = [&](auto best) {
    order.push_back(*best);
    left.erase(best);
  };
  const auto size = [&](std::size_t s) { return std::abs(bendOf(surfaces[s])); };
  take(std::min_element(left.begin(), left.end(), [&](auto a, auto b) { return size(a) < size(b); }));
  while (!left.empty()) {
    const auto distance = [&](std::size_t s) {
      double least = INFINITY;
      for (const std::size_t other : order)
        least = std::min(least, std::abs(bendOf(surfaces[s]) - bendOf(surfaces[other])));
      return least;
    };
    take(std::max_element(left.begin(), left.end(),
                          [&](auto a, auto b) { return distance(a) < distance(b); }));
  }
  return order;
}

class Proposal {
 public:
  explicit Proposal(const PlanRequest& request)
      : request_(request),
        recipe_(recipeFor(request.purpose)),
        by_importance_(byImportance(request.surfaces)) {
    whole_ = {static_cast<unsigned>(request.surfaces.size() - 1),
              recipe_.mounts - 1,
              4,
              recipe_.hold ? 2u : 0u,
              recipe_.breaks ? 1u : 0u,
              1};
  }

  ProposedPlan run() const {
    requireTime();
    Extent extent = whole_;
    for (const Rung& rung : recipe_.ladder) {
      while (!fits(extent) && extent[rung.lever] > rung.to) --extent[rung.lever];
    }
    for (auto rung = recipe_.ladder.rbegin(); rung != recipe_.ladder.rend(); ++rung) {
      for (Extent more = extent; more[rung->lever] < whole_[rung->lever]; extent = more) {
        ++more[rung->lever];
        if (!fits(more)) break;
      }
    }
    return {planOf(extent), planOf(whole_)};
  }

 private:
  bool fits(const Extent& extent) const { return sessionDuration(planOf(extent)) <= request_.time; }

  void requireTime() const {
    const SessionPlan smallest = planOf(Extent{});
    const double least = sessionDuration(smallest);
    if (least <= request_.time) return;
    throw settings::InputError(
        "--minutes is " + roundedText(request_.time / 60, 4) + ", but one cycle on " +
        smallest.surfaces.front().surface.name + " takes " +
        settings::fixedText(std::ceil(least / 6) / 10, 1) + " min with the conditioning, the rests and " +
        roundedText(request_.change / 60, 2) + " min to put the sheet on; give at least " +
        settings::fixedText(std::ceil(least / 6) / 10, 1));
  }

  SessionPlan planOf(const Extent& extent) const {
    SessionPlan plan;
    plan.origin = "plan";
    plan.name = name(request_.purpose);
    plan.purpose = request_.purpose;
    plan.seed = request_.seed;
    plan.thermometer = request_.thermometer;
    plan.chamber_limit = request_.chamber_limit;
    plan.change = request_.change;
    plan.matrix = request_.matrix;
    const double by = request_.peak / kFullPeak;
    plan.conditioning.cycles = recipe_.conditioning;
    plan.conditioning.rate = rounded(40e3 * by);
    plan.repeat_first = extent[kRepeat] > 0;
    addSurfaces(extent, plan);
    addProgram(extent, by, plan);
    if (extent[kBreaks] > 0) plan.breaks = {{static_cast<unsigned>((mountsOf(plan) + 1) / 2), kBreak}};
    fitBreaks(plan);
    return plan;
  }

  void addSurfaces(const Extent& extent, SessionPlan& plan) const {
    std::vector<std::size_t> kept(by_importance_.begin(), by_importance_.begin() + extent[kSurfaces] + 1);
    std::sort(kept.begin(), kept.end());
    for (const std::size_t s : kept) plan.surfaces.push_back({request_.surfaces[s], extent[kMounts] + 1});
  }

  void addProgram(const Extent& extent, double by, SessionPlan& plan) const {
    const double share = kShares[extent[kCycles]];
    for (simulation::ProgramPart part : recipe_.program) {
      auto* const cycles = std::get_if<ChamberProtocol>(&part);
      if (cycles != nullptr) cycles->cycles = std::max(1u, unsigned(std::lround(share * cycles->cycles)));
      if (share > 0 || plan.program.empty()) plan.program.push_back(part);
    }
    if (extent[kHold] > 0)
      plan.program.push_back(simulation::HoldPart{kFullPeak / 2, 40e3, kHolds[extent[kHold]]});
    for (simulation::ProgramPart& part : plan.program) std::visit(Scale{by}, part);
  }

  const PlanRequest& request_;
  Recipe recipe_;
  std::vector<std::size_t> by_importance_;
  Extent whole_{};
};

void requirePeak(const PlanRequest& request) {
  const double share = Conditioning{}.share_of_peak;
  if (share * request.peak <= request.chamber_limit) return;
  throw settings::InputError("--peak is " + roundedText(request.peak / 1e3) + ", but the conditioning at " +
                             roundedText(100 * share) + " % of it would pass the " +
                             roundedText(request.chamber_limit / 1e3) + " kPa of the chamber; give at most " +
                             roundedText(std::floor(request.chamber_limit / share / 1e3)));
}

}  // namespace

ProposedPlan proposePlan(const PlanRequest& request) {
  if (request.surfaces.empty()) throw settings::InputError("--surfaces is empty, but one surface is needed");
  requirePeak(request);
  ProposedPlan proposed = Proposal(request).run();
  validate(proposed.plan);
  return proposed;
}

}  // namespace fsr::session
