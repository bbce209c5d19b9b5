#pragma once

#include <string>

#include "check/socket_check.h"
#include "discrepancy/samples/admission.h"

namespace fsr::report {

/// A table of the recordings, their coverage, faults, problems and remarks, and the verdict as the last line:
/// "Fit for training and for discrepancy.", "Fit for training; not for discrepancy, because ..." or
/// "Not fit, because ...".
std::string admissionText(const discrepancy::Admission& admission);

/// The check of a recording without reference, and the verdict as the last line: "Readings are usable; no
/// reference: accuracy not assessed." or "Look again, because A; and 1 more; no reference: accuracy not
/// assessed."
std::string socketText(const check::SocketCheck& check);

}  // namespace fsr::report
