#pragma once

#include <string>

#include "blind/blind_case.h"

namespace blind {

/// Writes FOLDER/bags/*.bag and FOLDER/key.yaml of a case with a name. Bags of an earlier case in that folder
/// are removed. Throws fsr::InputError.
void writeCase(const BlindCase& made, const std::string& folder);

}  // namespace blind
