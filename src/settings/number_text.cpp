#include "settings/number_text.h"

#include <cmath>
#include <ctime>
#include <iomanip>
#include <sstream>

namespace fsr::settings {

namespace {

constexpr const char* kNoNumber = "-";
constexpr double kLong = 1e15;  // a double has no more digits that mean anything

}  // namespace

std::string fixedText(double value, int decimals) {
  if (!(std::abs(value) < kLong)) return roundedText(value);
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string percentText(double share, int decimals) {
  return std::isfinite(share) ? fixedText(100 * share, decimals) + " %" : kNoNumber;
}

std::string roundedText(double value, int digits) {
  if (!std::isfinite(value)) return kNoNumber;
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string fixedPressure(double pressure, int decimals) {
  return inShownUnit(pressure, decimals) + ' ' + shownUnitName();
}

std::string roundedPressure(double pressure, int digits, PressureUnit unit) {
  return roundedText(pressure / pascals(unit), digits) + ' ' + name(unit);
}

std::string inShownUnit(double pressure, int decimals) {
  return fixedText(pressure / shownUnitSize(), decimals);
}

std::string shownUnitName() {
  return name(shownUnit());
}

std::string megabytesText(std::uint64_t bytes) {
  return fixedText(static_cast<double>(bytes) / 1e6, 1) + " MB";
}

std::string nowText() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace fsr::settings
