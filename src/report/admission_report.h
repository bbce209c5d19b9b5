#pragma once

#include <string>

#include "calibration/socket_check.h"
#include "discrepancy/samples/admission.h"

namespace fsr::report {

/// Recordings as a table, coverage, faults, problems and remarks, and the verdict as the last line:
/// "Fit for training and for discrepancy.", "Fit for training; not for discrepancy, because ..." or
/// "Not fit, because ...".
std::string admissionText(const discrepancy::Admission& admission);

/// What a recording without reference says of itself, and the verdict as the last line: "Readings are usable;
/// no reference: accuracy not assessed." or "Look again, because A; and 1 more; no reference: accuracy not
/// assessed."
std::string socketText(const calibration::SocketCheck& check);

}  // namespace fsr::report
