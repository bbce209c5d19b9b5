#pragma once

#include <cstdint>
#include <string>

#include "fsr_pressure_map/settings/pressure_unit.h"

namespace fsr::settings {

// Numbers in text for people. What is no finite number has the text "-", whatever the function.

/// `value` with `decimals` digits behind the point: fixedText(1234.56, 1) = "1234.6"; with an exponent from
/// 1e15 on. Also in place of std::lround, whose result is no number for a value outside its range.
std::string fixedText(double value, int decimals);

/// A share as percent: percentText(0.1234) = "12.3 %".
std::string percentText(double share, int decimals = 1);

/// `value` with up to `digits` significant digits and no trailing zeros, with an exponent where the number
/// would be long otherwise: roundedText(0.012345, 3) = "0.0123", roundedText(1e7) = "1e+07".
std::string roundedText(double value, int digits = 6);

/// A pressure [Pa] with its unit: fixedPressure(12345, 1) = "12.3 kPa", roundedPressure(12345, 4) = "12.35
/// kPa".
std::string fixedPressure(double pressure, int decimals);
std::string roundedPressure(double pressure, int digits, PressureUnit unit = shownUnit());
/// The number alone, and the name of its unit.
std::string inShownUnit(double pressure, int decimals = 1);
std::string shownUnitName();
/// Its size [Pa].
inline double shownUnitSize() {
  return pascals(shownUnit());
}

/// `bytes` in megabytes of 1e6 bytes: "12.3 MB".
std::string megabytesText(std::uint64_t bytes);

/// The current time in UTC by ISO 8601: "2026-11-25T09:30:00Z".
std::string nowText();

}  // namespace fsr::settings
