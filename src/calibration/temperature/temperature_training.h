#pragma once

#include "calibration/history_training.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Chooses a model of the temperature, or none. `calibration` was trained without one; its scores receive the
/// choice. The lag is that with the smallest error of readings that were left out, see fitTemperature(). The
/// model is taken by the rule of trainHistory(), for protocols and, where the bags are several, also for
/// recordings: on each one that was left out, the answer of the family in use is worse by more than 1 % on
/// none and better by 2 % over all of them. A model that is present() must be trained: see atReference().
compensation::TemperatureModel chooseTemperature(const HistoryProblem& problem,
                                                 const CalibrationOptions& options, Calibration& calibration);

}  // namespace fsr::calibration
