#pragma once

#include <string>
#include <vector>

#include "blind/blind_case.h"
#include "blind/path_builder.h"

namespace blind {

/// A plan made by hand: 4 x 4 taxels at 10 Hz, straight ramps over 620 kPa, a room that keeps its
/// temperature.
inline RigPlan handPlan(std::vector<int> radii_mm) {
  RigPlan plan;
  plan.protocol_class = "by_hand";
  plan.matrix = {4, 4};
  plan.radii = std::move(radii_mm);
  plan.reach.assign(plan.radii.size(), 1.0);
  plan.room = {22, 0, "ramp", 0.02, 700};
  plan.reference = {50, 0, 1e-4, 0, 0, 0, 16};
  plan.cut.kind = "by_surface";
  plan.fastest = 10;
  plan.slowest = 10;
  return plan;
}

/// Adds a stay of `cycles` equal cycles at one pace, or, where `rich`, of cycles with two paces, dwells,
/// inner loops, and peaks and rests that differ.
inline void addStay(RigPlan& plan, std::size_t surface, int cycles, bool rich) {
  PathBuilder path;
  path.hold(3);
  for (int i = 0; i < cycles; ++i) {
    const double seconds = rich && i % 2 == 1 ? 40 : 10;
    const double rate = kPeak / seconds, peak = rich ? kPeak * (i % 3 == 0 ? 1 : 0.4 + 0.1 * i) : kPeak;
    path.cycle().ramp(rich ? 0.6 * peak : peak, rate);
    if (rich) path.hold(8).ramp(0.3 * peak, rate).ramp(peak, rate).hold(12);
    path.hold(1).ramp(0, rate).hold(rich ? 2 + 5 * (i % 3) : 2);
    if (rich) plan.slowest = 40;
  }
  path.hold(2);
  plan.visits.push_back({surface, path.take(), 0, 300});
  plan.cycles += static_cast<std::size_t>(cycles);
}

inline CaseSpec handCase(const std::string& name, const RigPlan& plan, const std::string& id,
                         const std::string& form, double snr = 1) {
  CaseSpec spec;
  spec.name = name;
  spec.plan = plan;
  spec.snr = snr;
  spec.local = false;
  if (!id.empty()) spec.effects = {{id, form, {}}};
  return spec;
}

}  // namespace blind
