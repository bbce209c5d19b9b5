#include "fsr_pressure_map/settings/range.h"

#include <cmath>
#include <sstream>

namespace fsr::settings {

std::string Range::text() const {
  std::ostringstream out;
  out.precision(10);  // 12000000 baud, not 1.2e+07
  const bool bounded_low = std::isfinite(low);
  const bool bounded_high = std::isfinite(high);
  if (bounded_low && bounded_high) {
    out << low << " to " << high;
  } else if (bounded_low) {
    out << low;
  } else if (bounded_high) {
    out << high;
  } else {
    out << "any number";
  }
  if (!unit.empty()) out << ' ' << unit;
  if (bounded_low && !bounded_high) out << " or more";
  if (!bounded_low && bounded_high) out << " or less";
  return out.str();
}

}  // namespace fsr::settings
