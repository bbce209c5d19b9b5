#pragma once

#include <Eigen/Dense>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// What a small change of each parameter of the enabled effects with a time course would add to the common
/// trace [samples x parameters]. These parameters were fitted while other effects were
/// missing, so they may be wrong by as much as the missing effects allow.
Eigen::MatrixXd enabledColumns(const Measured& measured, const StaticFit& fit,
                               const simulation::SimulationSettings& settings);

}  // namespace fsr::discrepancy
