#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "calibration/history_training.h"
#include "calibration/session/session_rests.h"
#include "calibration/training_scans.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Chooses whether the calibration expects a tare at the start of a session, see SessionZero. Each session in
/// turn is predicted by tables that were trained without it, with the zero of its own rest. `calibration`
/// must have the taxels without a model; it receives the choice and its scores. Returns the zeros to train
/// the tables with, empty where they are trained as without a tare. Throws InputError if a tare is asked for
/// and no session can be left out.
SessionZeros chooseSessionZero(const HistoryProblem& problem, const Sessions& sessions,
                               const CalibrationOptions& options, Calibration& calibration);

}  // namespace fsr::calibration
