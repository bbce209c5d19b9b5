#include <cmath>
#include <iomanip>
#include <sstream>

#include "report/curvature_error_report.h"
#include "report/history_report.h"
#include "report/study/study_report.h"
#include "settings/number_text.h"
#include "study/paper.h"

namespace fsr::report {

namespace {

constexpr int kNameWidth = 20;
constexpr double kKilopascal = 1e3;  // [Pa]

std::string number(double value, int digits) {
  const std::string text = settings::fixedText(value, digits);
  const bool negative_zero = text.find_first_not_of("-0.") == std::string::npos && text != "-";
  return negative_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string spread(const statistics::Spread& value, int digits, int deviation_digits) {
  if (!std::isfinite(value.mean)) return "-";
  return number(value.mean, digits) + " +- " + number(value.deviation, deviation_digits);
}

void cell(std::ostream& out, const std::string& text, int width) {
  out << std::setw(width) << text;
}

std::string probability(double p) {
  if (std::isnan(p)) return "p -";
  return p < 0.001 ? "p < 0.001" : "p = " + number(p, 3);
}

std::string testText(const statistics::TestResult& test, double p) {
  std::string freedom;
  for (const double degrees : test.degrees_of_freedom) {
    freedom += (freedom.empty() ? "(" : ", ") + number(degrees, std::floor(degrees) == degrees ? 0 : 2);
  }
  return test.test + ", " + test.symbol + (freedom.empty() ? "" : freedom + ")") + " = " +
         number(test.statistic, 2) + ", " + probability(p) + ", n = " + std::to_string(test.n) + " taxels";
}

void scoreHeads(std::ostream& out) {
  out << std::left << std::setw(kNameWidth) << "" << std::right;
  for (const char* const head : {"R2", "paper", "RMSE%", "paper"}) cell(out, head, 18);
  for (const char* const head : {"RMSE", "bias", "p95", "worst taxel"}) cell(out, head, 12);
  out << '\n' << std::setw(kNameWidth + 4 * 18) << "";
  for (const char* const unit : {"kPa", "kPa", "kPa", "RMSE%"}) cell(out, unit, 12);
  out << '\n';
}

void scoreRow(std::ostream& out, const study::StudyScore& score, const matrix::Layout& layout) {
  const study::PaperScore paper =
      study::paperScore(score.id == "grnn" ? "baseline" : score.id).value_or(study::PaperScore{});
  const statistics::ErrorSummary& errors = score.errors.whole.all;
  out << std::left << std::setw(kNameWidth) << score.label << std::right;
  cell(out, spread(score.r2_spread, 3, 4), 18);
  cell(out, spread(paper.r2, 2, 4), 18);
  cell(out, spread(score.rmse_percent_spread, 2, 2), 18);
  cell(out, spread(paper.rmse_percent, 2, 2), 18);
  for (const double value : {errors.rmse, errors.bias, errors.p95_absolute}) {
    cell(out, number(value / kKilopascal, 1), 12);
  }
  cell(out, number(score.worst_rmse_percent, 2), 12);
  out << "  row " << layout.row({score.worst_taxel}) << ", column " << layout.column({score.worst_taxel})
      << " (taxel " << score.worst_taxel << ")\n";
}

void comparisonText(std::ostream& out, const study::StudyComparison& comparison,
                    const matrix::Layout& layout) {
  out << '\n' << comparison.title << '\n';
  scoreHeads(out);
  for (const study::StudyScore& score : comparison.scores) scoreRow(out, score, layout);
  out << "As published, taxels treated as independent:\n";
  out << "  R2:    " << testText(comparison.r2.test, comparison.r2.p) << '\n';
  out << "  RMSE%: " << testText(comparison.rmse_percent.test, comparison.rmse_percent.p) << '\n';
  for (const std::string& sentence : study::paperStatements(comparison.id))
    out << "  The paper: " << sentence << '\n';
  out << "Difference of RMSE%, by bootstrap over whole units:\n";
  for (const study::StudyDifference& difference : comparison.differences) {
    const statistics::BootstrapResult& interval = difference.rmse_percent;
    out << "  " << std::left << std::setw(2 * kNameWidth) << difference.first + " - " + difference.second
        << std::right;
    if (interval.method == statistics::IntervalMethod::kNone) {
      out << number(interval.estimate, 2) << ", valid for these recordings only\n";
      continue;
    }
    out << number(interval.estimate, 2) << "  95 % interval " << number(interval.low, 2) << " to "
        << number(interval.high, 2) << " (" << interval.units << ' ' << interval.level << "s)\n";
  }
}

void splitText(std::ostream& out, const study::SplitResult& split) {
  out << '\n' << split.id << ": " << split.description << '\n';
  for (const study::StudyScore& score : split.scores) {
    out << "  " << std::left << std::setw(kNameWidth) << score.id << std::right
        << number(score.errors.whole.all.rmse / kKilopascal, 1) << " kPa  ("
        << number(score.rmse_interval.low / kKilopascal, 1) << " to "
        << number(score.rmse_interval.high / kKilopascal, 1) << "), RMSE% "
        << number(score.rmse_percent_spread.mean, 2) << '\n';
  }
}

std::string sentences(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& sentence : list) text += sentence + '\n';
  return text;
}

}  // namespace

std::string studyText(const study::StudyResult& result) {
  std::ostringstream out;
  out << result.scans << " scans of " << result.taxels.size() << " taxels on " << result.classes.size()
      << " conditions, " << result.cycles << " cycles, " << result.mounts << " mounts\n";
  for (const std::string& warning : result.warnings) out << "Warning: " << warning << '\n';
  for (const study::StudyComparison& comparison : result.comparisons)
    comparisonText(out, comparison, result.layout);
  if (!result.plan.beyond_the_paper) return out.str() + '\n' + sentences(result.holds_for);
  out << "\nAll scans, bandwidth chosen by nested cross-validation: RMSE with 95 % interval\n";
  for (const study::SplitResult& split : result.splits) {
    splitText(out, split);
    if (split.scores.back().id == "history") out << historyChoiceText(result.history);
  }
  if (result.history.protocols.empty()) out << "\nhistory: " << result.history.choice << '\n';
  out << curvatureErrorText(result.curvature_errors) << '\n' << result.headline.text << '\n';
  return out.str() + sentences(result.holds_for);
}

}  // namespace fsr::report
