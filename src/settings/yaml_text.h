#pragma once

#include <string>

namespace fsr::settings {

/// The shortest decimal text that a YAML or JSON reader turns back into the same number; `.inf` and `.nan`
/// as YAML spells them.
std::string numberText(double value);

/// Any text in double quotes, as YAML escapes it.
std::string quotedText(const std::string& text);

}  // namespace fsr::settings
