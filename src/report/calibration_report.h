#pragma once

#include <cstddef>
#include <string>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::report {

// A calibration's coverage and scores as text and as JSON. Nothing is computed here: every number is in the
// Calibration.

/// A table for the terminal: scans by curvature class, pressure bin and direction; then where data are
/// scarce.
std::string coverageText(const dataset::Coverage& coverage);

/// Tables for the terminal: R2 and RMSE% over taxels, errors in kPa for each class, then RMSE by pressure
/// bin and direction. One sentence if there are no scores. The worst taxel is named by row and column.
std::string scoresText(const calibration::CalibrationScores& scores, const matrix::Layout& layout);

/// The error on a curvature that was not used for training, in one line; "" if it was not assessed.
std::string unseenText(const calibration::UnseenScore& score);

/// Warnings, one a line; "" if there are none.
std::string warningsText(const calibration::Calibration& calibration);

/// The parameters that the scheme learned from the bags, in one line: "Curvature ranges: flat; cylinder_13cm,
/// cylinder_11cm" or "Length scale of curvature: 1.25 1/m"; "" if the scheme learns nothing.
std::string learnedText(const calibration::Calibration& calibration);

/// The model in a few words: "forest", "grnn, bandwidth 0.0312 (chosen)".
std::string modelText(const calibration::Calibration& calibration);

/// The whole calibration but its tables and statistics, as indented JSON. Numbers are SI; null = no value.
std::string calibrationJson(const calibration::Calibration& calibration);

/// What `train` prints of a training on one screen, at most kSummaryLines lines.
std::string trainingSummary(const calibration::Calibration& calibration);
constexpr std::size_t kSummaryLines = 25;

/// One line without an end: what the map is good for on a new mount of a known surface (the errors that 68
/// and 95 % of the readings of left-out mounts do not exceed), the worst mount by name, and what to do next.
std::string goodForText(const calibration::Calibration& calibration);

/// All tables of a training but its coverage.
std::string trainingDetails(const calibration::Calibration& calibration);

}  // namespace fsr::report
