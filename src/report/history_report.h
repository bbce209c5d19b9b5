#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"
#include "report/result_json.h"

namespace fsr::report {

/// Tables for the terminal: what was chosen as the model of the sheet's memory and why, the errors on
/// protocols that were left out, and errors by direction and by time since the last reversal. "" if no model
/// was asked for.
std::string historyText(const calibration::Calibration& calibration);

/// A table of errors of the static answer and with a model of the sheet's memory; "" if there are none.
std::string historyTable(const std::vector<calibration::HistoryScore::Part>& parts);

/// The model and its scores; null if no model was asked for. Numbers are SI.
Json historyJson(const calibration::Calibration& calibration);

}  // namespace fsr::report
