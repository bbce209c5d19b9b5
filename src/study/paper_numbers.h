#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::study {

// What the paper prints, to stand beside what we find. Source: Investigation of Regression Methods for
// Reduction of Errors Caused by Bending of FSR-Based Pressure Sensing Systems, Tables 2 and 3, sections 3
// and 4; means and deviations over 70 taxels.

struct PaperScore {
  statistics::Spread r2;
  statistics::Spread rmse_percent;
};

/// By the id of a method (study_method.h); nothing for a method that the paper lacks.
std::optional<PaperScore> paperScore(const std::string& method);

/// Friedman's chi2 of the algorithms and of the methods. NaN for another comparison.
struct PaperFriedman {
  double r2;
  double rmse_percent;
};
PaperFriedman paperFriedman(const std::string& comparison);

/// What the paper's text says of a comparison, one sentence each.
std::vector<std::string> paperStatements(const std::string& comparison);

}  // namespace fsr::study
