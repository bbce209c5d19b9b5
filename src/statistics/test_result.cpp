#include "statistics/test_result.h"

namespace fsr::statistics {

std::string pMethodName(PMethod method) {
  switch (method) {
    case PMethod::kExact:
      return "exact";
    case PMethod::kParametric:
      return "parametric";
    case PMethod::kNormalApproximation:
      return "normal approximation";
    case PMethod::kChiSquaredApproximation:
      return "chi-squared approximation";
    case PMethod::kNothingToTest:
      return "nothing to test";
  }
  return "unknown";
}

}  // namespace fsr::statistics
