#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "report/result_json.h"

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

// What training chose beside the tables, and why: the tare at the start of a session, the model of the
// temperature, and that of the sheet's memory. "" where nothing was asked for.

std::string sessionText(const calibration::SessionScore& score);
std::string temperatureText(const calibration::Calibration& calibration);
/// The choice with the errors on protocols that were left out, and errors by direction and by time since the
/// last reversal.
std::string historyText(const calibration::Calibration& calibration);
/// The choice with the errors of each family on each protocol.
std::string historyChoiceText(const calibration::HistoryScore& score);
/// A table of errors of the static answer and with a model of the sheet's memory; "" if there are none.
std::string historyTable(const std::vector<calibration::HistoryScore::Part>& parts);

/// The error budget in kPa, then the intervals with what they covered. One sentence where the calibration has
/// none.
std::string budgetText(const calibration::ErrorBudget& budget, const matrix::Layout& layout);
/// The same; null where there is none. Numbers are SI.
Json budgetJson(const calibration::ErrorBudget& budget);

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
