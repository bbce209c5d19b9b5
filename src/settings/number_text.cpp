#include "fsr_pressure_map/settings/number_text.h"

#include <charconv>
#include <cmath>

namespace fsr {

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

}  // namespace fsr
