#include "session/plan.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "session/plan_steps.h"
#include "settings/number_text.h"

namespace fsr::session {

namespace {

using settings::roundedText;
using simulation::ChamberProtocol;

constexpr double kFullPeak = 620e3;  // of the programs below; they are scaled to the user's peak [Pa]
constexpr double kBreak = 7200;  // longer than the pause by which `discrepancy` tells clock time from use [s]
constexpr std::size_t kAll = 1000;  // surfaces

/// A size of a plan.
struct Size {
  std::size_t surfaces;  // at least; further ones where they fit
  unsigned mounts;       // of each surface
  double cycles;         // share of those of the program; 0 = one cycle and nothing else
  double hold;           // [s]; 0 = none
  bool pause, again;     // a break of two hours; the first surface once more at the end
};

/// How a plan for a purpose looks: the whole one first, then what less time leaves of it.
struct PurposeTable {
  unsigned conditioning;                         // cycles
  std::vector<simulation::ProgramPart> program;  // the hold comes behind it
  std::vector<Size> sizes;
};

const PurposeTable& tableFor(Purpose purpose) {
  // Two paces, short and long dwells and partial loops, as `train --history` and `discrepancy` ask for.
  static const std::vector<simulation::ProgramPart> varied = {
      ChamberProtocol{kFullPeak, 40e3, 40e3, 1, 1, 3}, ChamberProtocol{kFullPeak, 40e3, 40e3, 10, 10, 2},
      simulation::LoopsPart{200e3, 400e3, 17e3, 2}, simulation::RestPart{17e3, 10},
      ChamberProtocol{kFullPeak, 8e3, 8e3, 10, 10, 1}};
  static const PurposeTable table[] = {
      // in the order of Purpose
      {// kPerCurvature
       5,
       {ChamberProtocol{kFullPeak, 17e3, 17e3, 1, 1, 10}},
       {{kAll, 2, 1, 0, false, true},
        {kAll, 1, 1, 0, false, true},
        {3, 1, 0.5, 0, false, true},
        {2, 1, 0.5, 0, false, true},
        {1, 1, 0.3, 0, false, false},
        {1, 1, 0, 0, false, false}}},
      {// kHistory
       5,
       varied,
       {{3, 1, 1, 300, false, true},
        {2, 1, 1, 60, false, true},
        {2, 1, 0.3, 60, false, true},
        {1, 1, 0.3, 60, false, false},
        {1, 1, 0.3, 0, false, false},
        {1, 1, 0, 0, false, false}}},
      {// kDiscrepancy
       5,
       varied,
       {{kAll, 2, 1, 300, true, true},
        {3, 2, 1, 300, false, true},
        {3, 1, 1, 300, false, true},
        {3, 1, 1, 60, false, true},
        {2, 1, 0.3, 60, false, true},
        {2, 1, 0.3, 0, false, true},
        {1, 1, 0.3, 0, false, false},
        {1, 1, 0, 0, false, false}}},
      {// kFieldCheck
       4,
       {ChamberProtocol{kFullPeak / 2, 17e3, 17e3, 1, 1, 2}, ChamberProtocol{kFullPeak, 17e3, 17e3, 1, 1, 3}},
       {{1, 1, 1, 0, false, true},
        {1, 1, 0.5, 0, false, true},
        {1, 1, 0.5, 0, false, false},
        {1, 1, 0, 0, false, false}}}};
  return table[static_cast<std::size_t>(purpose)];
}

// Three significant digits, so that the file can be read.
double rounded(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::round(value / unit) * unit;
}

/// Scales pressures and rates, so that the times stay. Called by std::visit.
struct Scale {
  double by;
  void operator()(ChamberProtocol& part) const { all({&part.peak, &part.fill_rate, &part.vent_rate}); }
  void operator()(simulation::HoldPart& part) const { all({&part.pressure, &part.rate}); }
  void operator()(simulation::LoopsPart& part) const { all({&part.low, &part.high, &part.rate}); }
  void operator()(simulation::RestPart& part) const { all({&part.rate}); }
  void all(std::initializer_list<double*> values) const {
    for (double* const value : values) *value = rounded(*value * by);
  }
};

// Surfaces in the order in which they matter: the least and the most bent one, then always the one in the
// middle of the widest gap. The flat surface, if there is one, comes first, since every sheet is used flat.
std::vector<std::size_t> byImportance(const std::vector<matrix::Surface>& surfaces) {
  std::vector<std::size_t> order, left;
  for (std::size_t s = 0; s < surfaces.size(); ++s) left.push_back(s);
  const auto distance = [&](std::size_t s) {
    double least = order.empty() ? -std::abs(bendOf(surfaces[s])) : INFINITY;
    for (const std::size_t other : order)
      least = std::min(least, std::abs(bendOf(surfaces[s]) - bendOf(surfaces[other])));
    return least;
  };
  while (!left.empty()) {
    const auto best =
        std::max_element(left.begin(), left.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
    order.push_back(*best);
    left.erase(best);
  }
  return order;
}

std::vector<simulation::ProgramPart> programOf(const PurposeTable& table, const Size& size, double by) {
  std::vector<simulation::ProgramPart> program;
  for (simulation::ProgramPart part : table.program) {
    auto* const cycles = std::get_if<ChamberProtocol>(&part);
    if (cycles != nullptr) cycles->cycles = std::max(1u, unsigned(std::lround(size.cycles * cycles->cycles)));
    if (size.cycles > 0 || program.empty()) program.push_back(part);
  }
  if (size.hold > 0) program.push_back(simulation::HoldPart{kFullPeak / 2, 40e3, size.hold});
  for (simulation::ProgramPart& part : program) std::visit(Scale{by}, part);
  return program;
}

// A plan of this size with `surfaces` of them.
SessionPlan planOf(const PlanRequest& request, const Size& size, std::size_t surfaces) {
  SessionPlan plan = request.like;
  const PurposeTable& table = tableFor(plan.purpose);
  const double by = request.peak / kFullPeak;
  plan.origin = "plan";
  plan.name = name(plan.purpose);
  plan.conditioning.cycles = table.conditioning;
  plan.conditioning.rate = rounded(40e3 * by);
  plan.repeat_first = size.again;
  std::vector<std::size_t> kept = byImportance(request.surfaces);
  kept.resize(surfaces);
  std::sort(kept.begin(), kept.end());
  for (const std::size_t s : kept) plan.surfaces.push_back({request.surfaces[s], size.mounts});
  plan.program = programOf(table, size, by);
  if (size.pause) plan.breaks = {{static_cast<unsigned>((mountsOf(plan) + 1) / 2), kBreak}};
  return plan;
}

[[noreturn]] void refuseTime(const PlanRequest& request, const SessionPlan& smallest) {
  const std::string least = settings::fixedText(std::ceil(sessionDuration(smallest) / 6) / 10, 1);
  throw settings::InputError("--minutes is " + roundedText(request.time / 60, 4) + ", but one cycle on " +
                             smallest.surfaces.front().surface.name + " takes " + least +
                             " min with the conditioning, the rests and " +
                             roundedText(request.like.change / 60, 2) +
                             " min to put the sheet on; give at least " + least);
}

void requirePeak(const PlanRequest& request) {
  const double share = Conditioning{}.share_of_peak;
  if (share * request.peak <= request.like.chamber_limit) return;
  throw settings::InputError("--peak is " + roundedText(request.peak / 1e3) + ", but the conditioning at " +
                             roundedText(100 * share) + " % of it would pass the " +
                             roundedText(request.like.chamber_limit / 1e3) +
                             " kPa of the chamber; give at most " +
                             roundedText(std::floor(request.like.chamber_limit / share / 1e3)));
}

}  // namespace

ProposedPlan proposePlan(const PlanRequest& request) {
  if (request.surfaces.empty()) throw settings::InputError("--surfaces is empty, but one surface is needed");
  requirePeak(request);
  const std::vector<Size>& sizes = tableFor(request.like.purpose).sizes;
  const std::size_t all = request.surfaces.size();
  for (const Size& size : sizes) {
    for (std::size_t surfaces = all; surfaces >= std::min(all, size.surfaces); --surfaces) {
      const SessionPlan plan = planOf(request, size, surfaces);
      if (sessionDuration(plan) > request.time) continue;
      validate(plan);
      return {plan, planOf(request, sizes.front(), all)};
    }
  }
  refuseTime(request, planOf(request, sizes.back(), 1));
}

}  // namespace fsr::session
