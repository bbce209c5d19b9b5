#pragma once

#include <string>

#include "fsr_pressure_map/calibration/error_budget.h"

namespace fsr::calibration {

/// "that of the tables", or "that of the tables times 0.92 to 1.31 by pressure".
std::string deviationText(const DeviationScale& scale);

}  // namespace fsr::calibration
