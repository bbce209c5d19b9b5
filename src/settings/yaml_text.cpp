#include "settings/yaml_text.h"

#include <charconv>
#include <cmath>

namespace fsr::settings {

std::string numberText(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value < 0 ? "-.inf" : ".inf";
  const double size = std::abs(value);
  const bool plain = value == 0 || (size >= 1e-5 && size < 1e12);
  const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, format).ptr;
  return {text, end};
}

std::string quotedText(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\n') {
      result += "\\n";
    } else {
      if (c == '"' || c == '\\') result += '\\';
      result += c;
    }
  }
  return '"' + result + '"';
}

}  // namespace fsr::settings
