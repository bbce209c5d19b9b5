#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"
#include "report/result_json.h"

namespace fsr::report {

/// For the terminal: the error budget in kPa, then the intervals with what they covered. One sentence where
/// the calibration has none.
std::string budgetText(const calibration::ErrorBudget& budget, const matrix::Layout& layout);

/// The same; null where there is none. Numbers are SI.
Json budgetJson(const calibration::ErrorBudget& budget);

}  // namespace fsr::report
