#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr_ros {

/// What `--history` asks for: "auto", the name of a family, or the path of a verdict.yaml. The effects that
/// it names propose a family, which is tried before the others; held-out error still decides. A verdict
/// without an effect that memory describes proposes nothing, and `remark` receives a sentence that says so.
/// Throws InputError if the text is none of these.
fsr::calibration::HistoryChoice historyOption(const std::string& text, std::string& remark);

/// The family that describes these effects: one that depends on earlier extremes is a loop, one that depends
/// on the time since the last reversal fades. kNone if none of them does.
fsr::calibration::HistoryFamily historyFamilyOf(const std::vector<std::string>& effects);

/// Whether a model of the temperature is tried: "auto", "none", or "" = as the history, which is not static.
/// Throws InputError for another text.
bool temperatureOption(const std::string& text, const fsr::calibration::HistoryChoice& history);

}  // namespace fsr_ros
