#pragma once

#include <string>

#include "conductor/conductor.h"

namespace fsr::conductor {

/// Writes the state of a session; a program that is killed leaves the old file or the new one. Form:
///
///     plan: "day"
///     digest: "9f86d0..."    # see digestOf(); earlier ones are of the text of the plan beside the state
///     time: 1700000000.5     # [s]
///     rejected: 3            # attempts
///     steps: "aaas......"    # a = accepted, s = skipped, . = open
///     remarks:               # may be left out; steps from 1; no reason = accepted by hand
///       - {step: 8, reason: peak_missed, sentence: "the highest pressure was 400 kPa"}
///
/// Throws InputError.
void writeState(const std::string& path, const ConductorState& state);

/// Throws InputError where the file is no such state.
ConductorState readState(const std::string& path);

}  // namespace fsr::conductor
