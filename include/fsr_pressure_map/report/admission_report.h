#pragma once

#include <string>

#include "fsr_pressure_map/calibration/socket_check.h"
#include "fsr_pressure_map/discrepancy/admission.h"

namespace fsr {

/// Recordings as a table, coverage, faults, problems and remarks, and the verdict as the last line:
/// "Fit for training and for discrepancy.", "Fit for training; not for discrepancy, because ..." or
/// "Not fit, because ...".
std::string admissionText(const Admission& admission);

/// What a recording without reference says of itself, and the verdict as the last line: "Readings are usable;
/// no reference: accuracy not assessed." or "Look again, because A; and 1 more; no reference: accuracy not assessed."
std::string socketText(const SocketCheck& check);

}  // namespace fsr
