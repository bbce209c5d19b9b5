#pragma once

#include <vector>

#include "compensation/fit_scheme.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// What a history model is trained on. All must outlive the call.
struct HistoryProblem {
  const std::vector<dataset::Recording>& recordings;
  const dataset::ConditionClasses& classes;
  const std::vector<dataset::Sections>& sections;
  const compensation::SchemePlan& plan;
  const regression::RegressorOptions& regressor;
};

/// Chooses and trains the model of the sheet's memory. Each protocol in turn is predicted by tables and
/// models that were trained without it. `calibration` must have its tables; it receives the model and its
/// scores. If the choice is automatic, a family is taken only if it is worse than the static answer by more
/// than 1 % on no protocol, and better by 2 % over all of them than the static answer and than c(x) alone.
/// Throws InputError if a family is asked for and no protocol can be left out.
void trainHistory(const HistoryProblem& problem, const CalibrationOptions& options, Calibration& calibration);

}  // namespace fsr::calibration
