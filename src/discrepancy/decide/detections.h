#pragma once

#include <string>
#include <vector>

#include "discrepancy/decide/decision.h"
#include "discrepancy/fit/mains.h"
#include "discrepancy/fit/static_layer.h"
#include "discrepancy/samples/faults.h"

namespace fsr::discrepancy {

/// An effect that a detector found. It is reported beside the explanation of the common trace.
struct Detection {
  FoundEffect effect;
  std::vector<simulation::EnabledEffect> enable;  ///< its settings; empty if it cannot be simulated
  std::vector<std::string> depends_on;
  WhereItShows where;
  double before_more = 0;  ///< squared error of the gap before that the residual does not contain
  double after_less = 0;   ///< squared error that the gap after and the floor do not contain
  bool wrong_form = false;
};

Detection detectionOf(const Fault& fault, const FaultyReadings& readings, double square);
Detection detectionOf(const Mains& mains, double square, const Measured& measured);
Detection detectionOf(const Repositioning& repositioning, double square);
/// An effect that wanders at random. On some taxels only, it is stronger there than in the common trace, by
/// `amplitude`.
Detection detectionOf(const RandomFinding& finding, const simulation::EffectInfo& info,
                      const WhereItShows& where, double amplitude);
/// Saturation. Its level is fitted to the static curves.
Detection saturationOf(const StaticMisfit& misfit, const Measured& measured, const StaticFit& fit,
                       const simulation::SimulationSettings& base);

/// isMisfit(): whether the misfit of the static curves is more than chance. isSaturation(): whether the
/// misfit is a function of the code.
bool isMisfit(const StaticMisfit& misfit, bool something_else_found);
bool isSaturation(const StaticMisfit& misfit, const Measured& measured);

}  // namespace fsr::discrepancy
