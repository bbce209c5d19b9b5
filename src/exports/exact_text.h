#pragma once

#include <cstdint>
#include <string>

namespace fsr::exports {

/// The shortest text that reads back as the same number, in any locale; "NA" for NaN.
std::string exactText(float value);
std::string exactText(double value);

/// Nanoseconds as seconds with nine decimals, exactly: "12.345678900".
std::string secondsText(std::int64_t nanoseconds);

}  // namespace fsr::exports
