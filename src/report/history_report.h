#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"
#include "report/result_json.h"

namespace fsr::report {

/// Tables for the terminal: what was chosen as the model of the sheet's memory and why, the errors on
/// protocols that were left out, and errors by direction and by time since the last reversal. "" if no model
/// was asked for.
std::string historyText(const calibration::Calibration& calibration);

/// What was chosen and why, and the errors of each family on each protocol.
std::string historyChoiceText(const calibration::HistoryScore& score);

/// A table of errors of the static answer and with a model of the sheet's memory; "" if there are none.
std::string historyTable(const std::vector<calibration::HistoryScore::Part>& parts);

/// Likewise what was chosen as the model of the temperature; "" without a thermometer or if none was asked
/// for.
std::string temperatureText(const calibration::Calibration& calibration);

/// The model of the temperature and its scores; null where temperatureText() is "".
Json temperatureJson(const calibration::Calibration& calibration);

/// The errors of each family on each protocol that was left out [Pa].
Json historyProtocolsJson(const calibration::HistoryScore& score);

/// The model and its scores; null if no model was asked for. Numbers are SI.
Json historyJson(const calibration::Calibration& calibration);

}  // namespace fsr::report
