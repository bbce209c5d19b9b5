#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::report {

// A calibration's coverage and scores for people and for programs. Nothing is computed here: every
// number stands in the Calibration.

/// A table for the terminal: scans by curvature class, pressure bin and direction; then what is thin.
std::string coverageText(const dataset::Coverage& coverage);

/// Tables for the terminal: R2 and RMSE% over taxels, errors in kPa for each class, then RMSE by pressure
/// bin and direction. A sentence where there are no scores.
std::string scoresText(const calibration::CalibrationScores& scores);

/// Warnings, one a line; "" where there are none.
std::string warningsText(const calibration::Calibration& calibration);

/// What the scheme learned from the bags, one line: "Curvature ranges: flat; cylinder_13cm, cylinder_11cm",
/// "Length scale of curvature: 1.25 1/m"; "" where it learns nothing.
std::string learnedText(const calibration::Calibration& calibration);

/// The model in a few words: "forest", "grnn, bandwidth 0.0312 (chosen)".
std::string modelText(const calibration::Calibration& calibration);

/// Everything but tables and statistics, indented. Numbers are SI; null = no value.
std::string calibrationJson(const calibration::Calibration& calibration);

}  // namespace fsr::report
