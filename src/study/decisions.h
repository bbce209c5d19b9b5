#pragma once

#include <string>
#include <vector>

#include "study/study_data.h"
#include "study/study_plan.h"

namespace fsr::study {

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

}  // namespace fsr::study
