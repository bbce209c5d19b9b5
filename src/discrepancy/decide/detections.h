#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/mains.h"
#include "discrepancy/fit/static_layer.h"
#include "discrepancy/samples/faults.h"

namespace fsr::discrepancy {

/// Something that a test of its own found, beside what all taxels share.
struct Detection {
  FoundEffect effect;
  std::vector<simulation::EnabledEffect> enable;  ///< how the simulation is told; none where it cannot be
  std::vector<std::string> depends_on;
  WhereItShows where;
  double before_more = 0;  ///< squared error that the gap before has more than the residual shows
  double after_less = 0;   ///< squared error that the gap after and the floor have less
  bool wrong_form = false;
};

Detection detectionOf(const Fault& fault, const FaultyReadings& readings, double square);
Detection detectionOf(const Mains& mains, double square, const Measured& measured);
Detection detectionOf(const Repositioning& repositioning, double square);
/// Saturation, with its level fitted to the static curves.
Detection saturationOf(const StaticMisfit& misfit, const Measured& measured, const StaticFit& fit,
                       const simulation::SimulationSettings& base);

/// Whether what the static curves differ by is more than chance, and whether it goes by code.
bool isMisfit(const StaticMisfit& misfit, bool something_else_found);
bool isSaturation(const StaticMisfit& misfit, const Measured& measured);

}  // namespace fsr::discrepancy
