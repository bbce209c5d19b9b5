#include "session/plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>
#include <variant>

#include "fsr_pressure_map/settings/input_error.h"
#include "session/plan_steps.h"
#include "settings/text.h"
#include "simulation/pressure_profile.h"

namespace fsr::session {

namespace {

using settings::numberText;

// In the order of Purpose.
constexpr const char* kNames[] = {"per_curvature", "history", "discrepancy", "field_check"};

struct Extent {
  double highest;  // pressure [Pa]
  double pieces;   // cycles, loops, holds or rests
};

/// Called by std::visit.
struct ExtentOf {
  Extent operator()(const simulation::ChamberProtocol& part) const {
    return {part.peak, double(part.cycles)};
  }
  Extent operator()(const simulation::HoldPart& part) const { return {part.pressure, 1}; }
  Extent operator()(const simulation::LoopsPart& part) const { return {part.high, double(part.loops)}; }
  Extent operator()(const simulation::RestPart&) const { return {0, 1}; }
};

// What a person at a rig can do. Also bounds the memory that a plan takes.
constexpr double kMostPieces = 100000;
constexpr double kLongest = 7 * 86400;  // [s]

[[noreturn]] void refuse(const SessionPlan& plan, const std::string& sentence) {
  throw settings::InputError(plan.origin + ": " + sentence);
}

void requirePressures(const SessionPlan& plan) {
  const double peak = largestPeak(plan), conditioning = conditioningPeak(plan);
  const std::string limit = ", but chamber_limit is " + numberText(plan.chamber_limit) + " Pa";
  if (peak > plan.chamber_limit) refuse(plan, "program reaches " + numberText(peak) + " Pa" + limit);
  if (plan.conditioning.cycles > 0 && conditioning > plan.chamber_limit) {
    refuse(plan, "conditioning reaches " + numberText(conditioning) + " Pa (share_of_peak " +
                     numberText(plan.conditioning.share_of_peak) + " of " + numberText(peak) + " Pa)" +
                     limit + "; give a smaller share_of_peak or smaller peaks");
  }
}

void requireSurfaces(const SessionPlan& plan) {
  if (plan.surfaces.empty()) refuse(plan, "surfaces is empty, but must contain at least one surface");
  std::set<std::string> names;
  for (std::size_t s = 0; s < plan.surfaces.size(); ++s) {
    const std::string& name = plan.surfaces[s].surface.name;
    if (!names.insert(name).second) {
      refuse(plan, "surfaces[" + std::to_string(s) + "].surface is " + name +
                       ", which is in the list already; give its number of mounts instead");
    }
  }
}

void requireProgram(const SessionPlan& plan) {
  if (!(largestPeak(plan) > 0))
    refuse(plan, "program applies no pressure, but must contain at least one cycle");
  if (!std::isfinite(simulation::pressureProfile(plan.program).duration()))
    refuse(plan, "program never ends; give cycles of 1 or more");
}

void requireDoable(const SessionPlan& plan) {
  double pieces = 0;
  for (const simulation::ProgramPart& part : plan.program) pieces += std::visit(ExtentOf{}, part).pieces;
  pieces *= static_cast<double>(mountsOf(plan));
  if (pieces > kMostPieces) {
    refuse(plan, "the session has " + numberText(pieces) +
                     " cycles, loops and holds on all mounts, but may have at most " +
                     numberText(kMostPieces));
  }
  if (const double length = sessionDuration(plan); length > kLongest) {
    refuse(plan, "the session takes " + numberText(std::round(length / 3600)) + " h, but may take at most " +
                     numberText(kLongest / 3600) + " h; make a plan for each week");
  }
}

void requireBreaks(const SessionPlan& plan) {
  const std::size_t mounts = mountsOf(plan);
  unsigned last = 0;
  for (std::size_t b = 0; b < plan.breaks.size(); ++b) {
    const unsigned after = plan.breaks[b].after;
    const std::string field = "breaks[" + std::to_string(b) + "].after is " + std::to_string(after);
    if (after >= mounts) {
      refuse(plan, field + ", but must be smaller than the number of mounts, " + std::to_string(mounts) +
                       ": a break lies between two mounts");
    }
    if (after <= last) refuse(plan, field + ", but must be larger than that of the break before it");
    last = after;
  }
}

}  // namespace

std::string name(Purpose purpose) {
  return kNames[static_cast<std::size_t>(purpose)];
}

std::vector<std::string> purposeNames() {
  return {std::begin(kNames), std::end(kNames)};
}

Purpose purposeCalled(const std::string& name) {
  const auto found = std::find(std::begin(kNames), std::end(kNames), name);
  if (found == std::end(kNames)) throw std::out_of_range(name);
  return static_cast<Purpose>(found - std::begin(kNames));
}

double bendOf(const matrix::Surface& surface) {
  double largest = 0;
  for (const matrix::Curvature& one : surface.curvature) {
    const double principal = matrix::principalCurvature(one);
    if (std::abs(principal) > std::abs(largest)) largest = principal;
  }
  return largest;
}

double largestPeak(const SessionPlan& plan) {
  double peak = 0;
  for (const simulation::ProgramPart& part : plan.program)
    peak = std::max(peak, std::visit(ExtentOf{}, part).highest);
  return peak;
}

double conditioningPeak(const SessionPlan& plan) {
  return plan.conditioning.share_of_peak * largestPeak(plan);
}

std::size_t mountsOf(const SessionPlan& plan) {
  std::size_t mounts = plan.repeat_first ? 1 : 0;
  for (const PlannedSurface& surface : plan.surfaces) mounts += surface.mounts;
  return mounts;
}

void validate(const SessionPlan& plan) {
  requireSurfaces(plan);
  requireProgram(plan);
  requirePressures(plan);
  requireBreaks(plan);
  requireDoable(plan);
}

}  // namespace fsr::session
