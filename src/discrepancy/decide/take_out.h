#pragma once

#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// Whether an effect without a detector changes with time under a uniform pressure.
bool hasTimeCourse(const simulation::EffectInfo& info);

/// Subtracts the effects that are in `with` but not in `without` from the readings. Afterwards the curves are
/// functions of the load that the chain computes, and the readings are those of a sheet without these
/// effects.
void takeOut(Measured& measured, const StaticFit& fit, const simulation::SimulationSettings& without,
             const simulation::SimulationSettings& with);

/// The same for all effects with a time course that the simulation enables. With `fit_sizes` their sizes are
/// fitted first. Returns the simulation with these sizes. `beside`: effects that are fitted together with
/// them but are not subtracted.
simulation::SimulationSettings takeOutEnabled(Measured& measured, const CommonTraces& common,
                                              const StaticFit& fit,
                                              const simulation::SimulationSettings& base, bool fit_sizes,
                                              const std::vector<simulation::EnabledEffect>& beside = {});

}  // namespace fsr::discrepancy
