#pragma once

#include <string>

#include "blind/blind_case.h"

namespace blind {

/// The sealed key: what was hidden, where it shows, by how much, and the spec that makes the case again.
/// YAML; README.md beside this file lists its fields.
std::string keyText(const BlindCase& blind_case);

/// What a user of the rig would know of the bags, and the SHA-256 of the key. YAML.
std::string publicText(const BlindCase& blind_case, const std::string& key_sha256);

/// The spec of a campaign with the same sheet and the same hidden effects, in strength and noise, as in a
/// key: with `then` it goes on under the experiment that was recommended. Throws fsr::InputError.
CaseSpec specFromKey(const std::string& path);

}  // namespace blind
