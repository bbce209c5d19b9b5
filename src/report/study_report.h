#pragma once

#include <map>
#include <string>

#include "study/study.h"

namespace fsr::report {

// A study's result for people and for programs. Nothing is computed here: every number stands in the
// StudyResult.

/// Tables for the terminal, the paper's numbers beside ours.
std::string studyText(const study::StudyResult& result);

/// Everything but the readings behind the figures, indented. Numbers are SI; null = no value.
std::string studyJson(const study::StudyResult& result);

/// CSV files by name: scores, taxel_scores, errors_by_bin, tests, differences, bandwidths, response,
/// prediction. Headings say their units.
std::map<std::string, std::string> studyTables(const study::StudyResult& result);

}  // namespace fsr::report
