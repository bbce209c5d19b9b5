#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"
#include "report/result_json.h"

namespace fsr::report {

// What training chose beside the tables, and why: the tare at the start of a session, the model of the
// temperature, and that of the sheet's memory. The texts are for the terminal, "" where nothing was asked
// for; the JSON is null there. Numbers of JSON are SI.

std::string sessionText(const calibration::SessionScore& score);
Json sessionJson(const calibration::Calibration& calibration);

std::string temperatureText(const calibration::Calibration& calibration);
Json temperatureJson(const calibration::Calibration& calibration);

/// The choice with the errors on protocols that were left out, and errors by direction and by time since the
/// last reversal.
std::string historyText(const calibration::Calibration& calibration);
Json historyJson(const calibration::Calibration& calibration);
/// The choice with the errors of each family on each protocol.
std::string historyChoiceText(const calibration::HistoryScore& score);
Json historyProtocolsJson(const calibration::HistoryScore& score);
/// A table of errors of the static answer and with a model of the sheet's memory; "" if there are none.
std::string historyTable(const std::vector<calibration::HistoryScore::Part>& parts);

}  // namespace fsr::report
