#pragma once

#include <string>

namespace fsr::settings {

/// The shortest decimal text that a YAML or JSON reader converts back to the same number; `.inf` and `.nan`
/// as in YAML.
std::string numberText(double value);

/// A text in double quotes, escaped for YAML.
std::string quotedText(const std::string& text);

}  // namespace fsr::settings
