#include "settings/number_text.h"

#include <atomic>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/pressure_unit.h"

namespace fsr::settings {

namespace {

std::atomic<PressureUnit> shown_unit{PressureUnit::kKilopascal};

}  // namespace

std::vector<std::string> pressureUnitNames() {
  return {"kPa", "mmHg"};
}

PressureUnit pressureUnitOf(const std::string& name) {
  if (name == "kPa") return PressureUnit::kKilopascal;
  if (name == "mmHg") return PressureUnit::kMillimetreOfMercury;
  throw InputError("unit is \"" + name + "\", but must be kPa or mmHg");
}

std::string name(PressureUnit unit) {
  switch (unit) {
    case PressureUnit::kKilopascal:
      return "kPa";
    case PressureUnit::kMillimetreOfMercury:
      return "mmHg";
    case PressureUnit::kCount:
      break;
  }
  return "counts";
}

double pascals(PressureUnit unit) {
  switch (unit) {
    case PressureUnit::kKilopascal:
      return 1000;
    case PressureUnit::kMillimetreOfMercury:
      return 133.322387415;
    case PressureUnit::kCount:
      break;
  }
  return 1;
}

PressureUnit shownUnit() {
  return shown_unit;
}

void showPressuresIn(PressureUnit unit) {
  shown_unit = unit;
}

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
