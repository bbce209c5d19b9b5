#pragma once

#include <cstdint>
#include <string>

namespace fsr::settings {

/// `value` with `decimals` digits behind the point: fixedText(1234.56, 1) = "1234.6". NaN gives "nan".
std::string fixedText(double value, int decimals);

/// The cell of a table: as fixedText, but "-" where there is no value (NaN).
std::string cellText(double value, int decimals);

/// `value` with up to `digits` significant digits and no trailing zeros, with an exponent where the number
/// would be long otherwise: roundedText(0.012345, 3) = "0.0123", roundedText(1e7) = "1e+07".
std::string roundedText(double value, int digits = 6);

/// `bytes` in megabytes of 1e6 bytes: "12.3 MB".
std::string megabytesText(std::uint64_t bytes);

}  // namespace fsr::settings
