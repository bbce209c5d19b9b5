#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "study/study.h"
#include "study/unit_bootstrap.h"

namespace fsr::study {

/// A method's score, with its squared errors by cycle for the intervals of differences between methods.
struct ScoredMethod {
  StudyScore score;
  CycleSums sums;
};

/// The result of a piece of a study. Pieces do not depend on each other.
struct StudyPiece {
  std::string part;                        ///< "algorithms", "methods", "bandwidths", or the id of a split
  std::vector<ScoredMethod> compared;      ///< of the paper's comparisons
  std::vector<BandwidthCurve> bandwidths;  ///< over the grid of bandwidths
  std::vector<StudyScore> held_out;        ///< of the split
  std::optional<StudyScore> with_history;  ///< likewise, with a model of the sheet's memory
  calibration::HistoryScore history;
  std::vector<CurvatureErrorCurve> curvature_errors;
  std::optional<TaxelResponse> response;
};

/// A study, or the pieces of it that one of several computers has computed.
struct StudyParts {
  /// Everything but what the pieces tell. `splits` have no scores yet.
  StudyResult frame;
  CycleUnits units;
  std::size_t pieces_of_study = 0;             ///< 0 to pieces_of_study - 1
  std::map<std::size_t, StudyPiece> computed;  ///< by number
};

/// Computes the pieces that `wanted` chooses by their number; none = all. Throws InputError.
StudyParts computeParts(const StudyProblem& problem, const std::function<bool(std::size_t)>& wanted,
                        const StudyProgress& progress);

/// The result of a study from all of its pieces: compares the methods, and names the headline.
StudyResult joinParts(const StudyParts& parts);

}  // namespace fsr::study
