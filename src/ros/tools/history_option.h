#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr_ros {

/// What `--history` asks for: "auto", the name of a family, or the path of a verdict.yaml. The effects that
/// it names propose a family, which is tried before the others; held-out error still decides. A verdict
/// without an effect that memory describes proposes nothing, and `remark` receives a sentence that says so.
/// Throws InputError if the text is none of these.
fsr::calibration::HistoryChoice historyOption(const std::string& text, std::string& remark);

}  // namespace fsr_ros
