#include "study/paper_numbers.h"

#include <cmath>
#include <map>

namespace fsr::study {

std::optional<PaperScore> paperScore(const std::string& method) {
  static const std::map<std::string, PaperScore> kScores = {
      {"flat_only", {{0.99, 0.0012}, {3.51, 0.19}}},      {"baseline", {{0.94, 0.013}, {6.93, 0.81}}},
      {"per_curvature", {{0.98, 0.0014}, {4.26, 0.18}}},  {"curvature_input", {{0.96, 0.0027}, {5.03, 0.20}}},
      {"flat_or_curved", {{0.97, 0.0055}, {4.66, 0.40}}}, {"binary_input", {{0.98, 0.0060}, {4.96, 0.64}}},
      {"one_hot", {{0.96, 0.003}, {5.05, 0.19}}},
  };
  const auto found = kScores.find(method);
  return found == kScores.end() ? std::nullopt : std::optional<PaperScore>(found->second);
}

PaperFriedman paperFriedman(const std::string& comparison) {
  if (comparison == "algorithms") return {107.31, 109.83};
  if (comparison == "methods") return {270.09, 246.83};
  return {NAN, NAN};
}

std::vector<std::string> paperStatements(const std::string& comparison) {
  static const std::map<std::string, std::vector<std::string>> kStatements = {
      {"algorithms",
       {"Friedman: chi2(2) = 107.31 (R2), 109.83 (RMSE%), p < 0.001.",
        "Linear regression is worse by both measures. GRNN and forest differ in R2, but not in RMSE%."}},
      {"flat_against_all", {"Student's paired t test: they differ by both measures."}},
      {"methods",
       {"Friedman: chi2(4) = 270.09 (R2), 246.83 (RMSE%), p < 0.001.",
        "All pairs differ by both measures. Method 1 is best. Method 3 is better than method 4 in RMSE% and "
        "worse in R2."}},
      {"one_hot", {"Student's paired t test: no significant difference by either measure."}},
  };
  const auto found = kStatements.find(comparison);
  return found == kStatements.end() ? std::vector<std::string>{} : found->second;
}

}  // namespace fsr::study
