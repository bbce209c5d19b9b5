#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compensation/scheme_plan.h"
#include "fsr_pressure_map/statistics/metrics.h"
#include "study/study_data.h"
#include "study/study_plan.h"

namespace fsr::study {

// Results that the paper reports, for comparison: means and deviations over 70 taxels. Source: C.
// Ahmadizadeh, C. Menon, "Investigation of Regression Methods for Reduction of Errors Caused by Bending of
// FSR-Based Pressure Sensing Systems Used for Prosthetic Applications", Sensors 2019, 19(24), 5519,
// doi:10.3390/s19245519, Tables 2 and 3, sections 3 and 4.

struct PaperScore {
  statistics::Spread r2;
  statistics::Spread rmse_percent;
};

/// Score of a method by its id; none if the paper does not have the method.
std::optional<PaperScore> paperScore(const std::string& method);

/// Friedman's chi2 of the comparisons "algorithms" and "methods". NaN for other comparisons.
struct PaperFriedman {
  double r2;
  double rmse_percent;
};
PaperFriedman paperFriedman(const std::string& comparison);

/// The paper's statements on a comparison, one sentence each.
std::vector<std::string> paperStatements(const std::string& comparison);

/// A point that the paper (Ahmadizadeh and Menon 2019, doi:10.3390/s19245519) leaves open or states wrongly,
/// and the study's decision.
struct StudyDecision {
  std::string subject;
  std::string paper;  ///< what the paper says
  std::string study;  ///< what the study does
};

std::vector<StudyDecision> studyDecisions(const StudyPlan& plan, const StudyData& data);

/// Whether the simulated rig of this name was fitted to the paper's tables.
bool fittedToThePaper(const std::string& simulation);

/// Numbers of the paper that no rig can match, and the reasons. One sentence or paragraph each.
std::vector<std::string> unmatchable();

/// Limits of the results: simulated data, one mount for each surface, one sheet. One sentence or paragraph
/// each.
std::vector<std::string> limitations(const StudyData& data, const std::string& simulation);

/// One column of the paper's tables: a scheme, and the share of the data that it uses.
struct StudyMethod {
  std::string id;     ///< name of the scheme, e.g. per_curvature
  std::string label;  ///< name in the paper, e.g. "Method 1"
  compensation::SchemePlan plan;
  std::vector<std::size_t> one_of;  ///< [classes]: the method uses one of so many scans; 0 = none

  /// Number of models whose scores are averaged. A scheme with a second input has one model.
  std::size_t models() const;
  /// The model that is trained on the class; models() if there is none.
  std::size_t modelOf(std::size_t curvature_class) const;
};

/// The paper's seven methods, in the order of its tables: flat, baseline, methods 1 to 4, and method 2 with a
/// one-hot input. Methods 3 and 4 are left out if there is no bent class. Throws InputError if there is no
/// flat class.
std::vector<StudyMethod> paperMethods(const StudyData& data, BinaryShare binary_share);

/// Schemes beyond the paper, on all scans: curvature with a length scale of its own, a learned monotone law
/// of curvature, interpolation between curvatures, and ranges of curvature chosen from data. Empty if there
/// is no bent class.
std::vector<StudyMethod> furtherMethods(const StudyData& data);

}  // namespace fsr::study
