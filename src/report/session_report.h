#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"
#include "report/result_json.h"

namespace fsr::report {

/// For the terminal: whether a tare is expected at the start of a session, and why, with the errors on
/// sessions that were left out. "" if it was not asked for.
std::string sessionText(const calibration::SessionScore& score);

/// The choice and its errors; null if it was not asked for. Numbers are SI.
Json sessionJson(const calibration::Calibration& calibration);

}  // namespace fsr::report
