#include "compensation/history_operators.h"

#include <stdexcept>
#include <utility>

namespace fsr::compensation {

HistoryOperators::HistoryOperators(std::vector<double> radii, const std::vector<double>& time_constants)
    : radii_(std::move(radii)), memories_(time_constants.begin(), time_constants.end()) {
  for (const double radius : radii_) {
    if (!(radius > 0)) throw std::invalid_argument("the radius of a play must be above 0");
  }
}

}  // namespace fsr::compensation
