#pragma once

#include <map>
#include <string>

#include "study/study_pieces.h"

namespace fsr::report {

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
