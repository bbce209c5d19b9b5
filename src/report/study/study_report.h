#pragma once

#include <map>
#include <string>

#include "study/study.h"

namespace fsr::report {

// A study's result as text, JSON and tables. Nothing is computed here: every number is in the StudyResult.

/// Tables for the terminal, with the paper's numbers beside those of the study.
std::string studyText(const study::StudyResult& result);

/// The whole result but the readings of the figures, as indented JSON. Numbers are SI; null = no value.
std::string studyJson(const study::StudyResult& result);

/// CSV files by name: scores, taxel_scores, errors_by_bin, tests, differences, bandwidths, response,
/// prediction, curvature_errors, curvature_errors_by_surface. Headings include the unit.
std::map<std::string, std::string> studyTables(const study::StudyResult& result);

}  // namespace fsr::report
