#pragma once

#include <string>

#include "blind/blind_case.h"

namespace blind {

/// The sealed key, as YAML: what was hidden, where it shows, how much, and the spec that generates the case
/// again. README.md in this folder lists its fields.
std::string keyText(const BlindCase& blind_case);

/// Reads from a key the spec of a campaign with the same sheet and the same hidden effects, strengths and
/// noise. With `then`, the campaign continues under a recommended experiment. Throws fsr::InputError.
CaseSpec specFromKey(const std::string& path);

}  // namespace blind
