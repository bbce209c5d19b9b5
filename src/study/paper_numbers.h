#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::study {

// Results that the paper reports, for comparison: means and deviations over 70 taxels. Source: C.
// Ahmadizadeh, C. Menon, "Investigation of Regression Methods for Reduction of Errors Caused by Bending of
// FSR-Based Pressure Sensing Systems Used for Prosthetic Applications", Sensors 2019, 19(24), 5519,
// doi:10.3390/s19245519, Tables 2 and 3, sections 3 and 4.

struct PaperScore {
  statistics::Spread r2;
  statistics::Spread rmse_percent;
};

/// Score of a method by its id (study_method.h); none if the paper does not have the method.
std::optional<PaperScore> paperScore(const std::string& method);

/// Friedman's chi2 of the comparisons "algorithms" and "methods". NaN for other comparisons.
struct PaperFriedman {
  double r2;
  double rmse_percent;
};
PaperFriedman paperFriedman(const std::string& comparison);

/// The paper's statements on a comparison, one sentence each.
std::vector<std::string> paperStatements(const std::string& comparison);

}  // namespace fsr::study
