#pragma once

#include <map>
#include <string>

#include "study/study.h"
#include "study/study_pieces.h"

namespace fsr::report {

// A study's result as text, JSON and tables. Nothing is computed here: every number is in the StudyResult.

/// Tables for the terminal, with the paper's numbers beside those of the study.
std::string studyText(const study::StudyResult& result);

/// The whole result but the readings of the figures, as indented JSON. Numbers are SI; null = no value.
std::string studyJson(const study::StudyResult& result);

/// CSV files by name: scores, taxel_scores, errors_by_bin, tests, differences, bandwidths, response,
/// prediction, curvature_errors, curvature_errors_by_surface. Headings include the unit.
std::map<std::string, std::string> studyTables(const study::StudyResult& result);

/// The pieces of a study that one computer has computed, as JSON from which they are read again exactly:
/// every number has all its digits, and "nan", "inf" and "-inf" are kept. The number of threads is left out.
std::string studyPartsJson(const study::StudyParts& parts);

/// Throws InputError with one sentence if the file cannot be read.
study::StudyParts readStudyParts(const std::string& path);

/// Adds the pieces of another computer. Throws InputError if they are of another study or are there already.
/// `name` and `first` name the files of `other` and `parts`.
void addStudyParts(study::StudyParts other, const std::string& name, const std::string& first,
                   study::StudyParts& parts);

/// The settings of a study, by name, as text: what two computers that share a study must have alike.
std::map<std::string, std::string> studyOptions(const study::StudyPlan& plan);

}  // namespace fsr::report
