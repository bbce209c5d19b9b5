#pragma once

#include <string>
#include <vector>

#include "study/study_data.h"
#include "study/study_plan.h"

namespace fsr::study {

/// Where the paper leaves something open or errs, and what the study does about it.
struct StudyDecision {
  std::string subject;
  std::string paper;  ///< what stands there
  std::string study;  ///< what was done
};

std::vector<StudyDecision> studyDecisions(const StudyPlan& plan, const StudyData& data);

/// Numbers of the paper that no rig can match, and why.
std::vector<std::string> unmatchable();

/// What the numbers do not say: of simulated data, of one mount, of one sheet.
std::vector<std::string> whatItHoldsFor(const StudyData& data, const std::string& simulation);

}  // namespace fsr::study
