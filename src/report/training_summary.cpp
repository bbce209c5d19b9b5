#include "report/training_summary.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "calibration/budget/new_mount_line.h"
#include "report/budget_report.h"
#include "report/calibration_report.h"
#include "report/history_report.h"
#include "report/session_report.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

// Lines of each kind that a summary has at most. Together with the heading, the row of all surfaces, a line
// for each of four choices, one for new curvatures and one for the budget they are kSummaryLines.
constexpr std::size_t kSurfaces = 8;
constexpr std::size_t kNotes = 2;
constexpr std::size_t kWarnings = 3;
constexpr std::size_t kThin = 1;

void summaryRow(std::ostream& out, const std::string& name, std::uint64_t scans, std::size_t cycles,
                const std::string& mounts, const calibration::Score& score) {
  const statistics::ErrorSummary& errors = score.errors.whole.all;
  out << std::left << std::setw(20) << (name.empty() ? "(no name)" : name) << std::right << std::setw(9)
      << scans << std::setw(8) << cycles << std::setw(8) << mounts << std::setw(11)
      << settings::fixedText(errors.rmse / 1e3, 1) << std::setw(11)
      << settings::fixedText(score.rmse_percent.mean, 2) << std::setw(15)
      << settings::fixedText(errors.p95_absolute / 1e3, 1) << '\n';
}

// The first sentences, one a line, and how many more there are.
void firstOf(std::ostream& out, const std::string& head, const std::vector<std::string>& sentences,
             std::size_t most) {
  for (std::size_t i = 0; i < std::min(most, sentences.size()); ++i) {
    const std::size_t more = i + 1 == most ? sentences.size() - most : 0;
    out << head << sentences[i] << (more > 0 ? " (and " + std::to_string(more) + " more: --details)" : "")
        << '\n';
  }
}

void surfaceRows(std::ostream& out, const calibration::Calibration& calibration) {
  const std::vector<dataset::ConditionCoverage>& rows = calibration.coverage.conditions;
  const calibration::CalibrationScores& scores = calibration.scores;
  out << "Held-out readings     scans  cycles  mounts   RMSE kPa     RMSE %    95 % within kPa\n";
  std::uint64_t scans = 0;
  std::size_t cycles = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    scans += rows[k].scans, cycles += rows[k].cycles;
    if (k >= kSurfaces) continue;
    summaryRow(out, rows[k].condition.surface, rows[k].scans, rows[k].cycles,
               rows[k].mounts.empty() ? "-" : std::to_string(rows[k].mounts.size()),
               k < scores.conditions.size() ? scores.conditions[k].score : calibration::Score{});
  }
  const std::string all = rows.size() > kSurfaces ? "all " + std::to_string(rows.size()) : "all together";
  summaryRow(out, all, scans, cycles, "", scores.whole);
}

// The sentence alone, without the table behind it.
void choiceLine(std::ostream& out, const std::string& choice) {
  if (!choice.empty()) out << choice << '\n';
}

void notes(std::ostream& out, const calibration::Calibration& calibration, std::size_t most_notes,
           std::size_t most_warnings) {
  firstOf(out, "Note: ", calibration.provenance.conditioning, most_notes);
  firstOf(out, "Warning: ", calibration.warnings, most_warnings);
}

}  // namespace

std::string trainingSummary(const calibration::Calibration& calibration) {
  std::ostringstream out;
  const calibration::CalibrationScores& scores = calibration.scores;
  surfaceRows(out, calibration);
  firstOf(out, "Few or no data: ", calibration.coverage.thin, kThin);
  notes(out, calibration, kNotes, kWarnings);
  out << unseenText(scores.unseen);
  for (const std::string& choice : {scores.session.choice, scores.temperature.choice, scores.history.choice})
    choiceLine(out, choice);
  out << learnedText(calibration);
  if (calibration.budget.present()) {
    out << "Combined standard uncertainty:";
    for (const double value : calibration.budget.combined) out << ' ' << settings::fixedText(value / 1e3, 1);
    out << " kPa at 10, 50 and 90 % of the trained pressures\n";
  }
  return out.str();
}

std::string trainingDetails(const calibration::Calibration& calibration) {
  std::ostringstream out;
  notes(out, calibration, std::string::npos, std::string::npos);
  out << scoresText(calibration.scores, calibration.layout) << sessionText(calibration.scores.session)
      << temperatureText(calibration) << historyText(calibration) << learnedText(calibration);
  if (calibration.budget.present()) out << '\n' << budgetText(calibration.budget, calibration.layout);
  return out.str();
}

std::string goodForText(const calibration::Calibration& calibration) {
  const std::string note = calibration::newMountNote(calibration.budget);
  return "Good for: " + (note.empty() ? "not known, because scores were not computed; next: train on all the "
                                        "bags without --no-scores"
                                      : note);
}

}  // namespace fsr::report
