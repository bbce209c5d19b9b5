#include "settings/number_text.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace fsr::settings {

std::string fixedText(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string cellText(double value, int decimals) {
  return std::isnan(value) ? "-" : fixedText(value, decimals);
}

std::string roundedText(double value, int digits) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string megabytesText(std::uint64_t bytes) {
  return fixedText(static_cast<double>(bytes) / 1e6, 1) + " MB";
}

}  // namespace fsr::settings
