#include <cmath>
#include <limits>

#include "report/calibration_report.h"
#include "report/study/study_report.h"
#include "report/text_table.h"
#include "settings/number_text.h"
#include "study/paper.h"

namespace fsr::report {

namespace {

std::string number(double value, int digits) {
  const std::string text = settings::fixedText(value, digits);
  const bool negative_zero = text.find_first_not_of("-0.") == std::string::npos && text != "-";
  return negative_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string spread(const statistics::Spread& value, int digits, int deviation_digits) {
  if (!std::isfinite(value.mean)) return "-";
  return number(value.mean, digits) + " +- " + number(value.deviation, deviation_digits);
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

std::string scoreTable(const std::vector<study::StudyScore>& scores, const matrix::Layout& layout) {
  TextTable table({"", "R2", "paper", "RMSE%", "paper", "RMSE", "bias", "p95", "worst taxel", ""}, {9});
  const std::string unit = settings::shownUnitName();
  table.row({"", "", "", "", "", unit, unit, unit, "RMSE%"});
  for (const study::StudyScore& score : scores) {
    const study::PaperScore paper =
        study::paperScore(score.id == "grnn" ? "baseline" : score.id).value_or(study::PaperScore{});
    const statistics::ErrorSummary& errors = score.errors.whole.all;
    const std::size_t worst = score.worst_taxel;
    table.row({score.label, spread(score.r2_spread, 3, 4), spread(paper.r2, 2, 4),
               spread(score.rmse_percent_spread, 2, 2), spread(paper.rmse_percent, 2, 2),
               inShownUnit(errors.rmse), number(errors.bias / settings::shownUnitSize(), 1),
               inShownUnit(errors.p95_absolute), number(score.worst_rmse_percent, 2),
               "row " + std::to_string(layout.row({worst})) + ", column " +
                   std::to_string(layout.column({worst})) + " (taxel " + std::to_string(worst) + ")"});
  }
  return table.text();
}

std::string comparisonText(const study::StudyComparison& comparison, const matrix::Layout& layout) {
  TextTable differences({}, {1});
  for (const study::StudyDifference& difference : comparison.differences) {
    const statistics::BootstrapResult& interval = difference.rmse_percent;
    const std::string said = interval.method == statistics::IntervalMethod::kNone
                                 ? "valid for these recordings only"
                                 : "95 % interval " + number(interval.low, 2) + " to " +
                                       number(interval.high, 2) + " (" + std::to_string(interval.units) +
                                       " " + interval.level + "s)";
    differences.row(
        {"  " + difference.first + " - " + difference.second, number(interval.estimate, 2) + "  " + said});
  }
  return "\n" + comparison.title + "\n" + scoreTable(comparison.scores, layout) +
         "As published, taxels treated as independent:\n  R2:    " +
         testText(comparison.r2.test, comparison.r2.p) +
         "\n  RMSE%: " + testText(comparison.rmse_percent.test, comparison.rmse_percent.p) + "\n" +
         linesOf(study::paperStatements(comparison.id), "  The paper: ") +
         "Difference of RMSE%, by bootstrap over whole units:\n" + differences.text();
}

std::string splitText(const study::SplitResult& split) {
  TextTable table({}, {1});
  for (const study::StudyScore& score : split.scores) {
    table.row({"  " + score.id, settings::fixedPressure(score.errors.whole.all.rmse, 1) + "  (" +
                                    inShownUnit(score.rmse_interval.low) + " to " +
                                    inShownUnit(score.rmse_interval.high) + "), RMSE% " +
                                    number(score.rmse_percent_spread.mean, 2)});
  }
  return "\n" + split.id + ": " + split.description + "\n" + table.text();
}

// "right", "-40 %", "+2 1/m".
std::string errorText(const study::CurvatureError& error) {
  const bool share = error.absolute == 0;
  const double size = share ? 100 * error.relative : error.absolute;
  if (size == 0) return "right";
  return (size > 0 ? "+" : "") + settings::roundedText(size) + (share ? " %" : " 1/m");
}

template <typename Cell>
std::string errorTable(const std::string& title, const std::vector<study::CurvatureErrorCurve>& curves,
                       Cell cell) {
  std::vector<std::string> headings = {"  curvature is"};
  for (const study::CurvatureErrorScore& score : curves.front().scores)
    headings.push_back(errorText(score.error));
  TextTable table(headings);
  for (const study::CurvatureErrorCurve& curve : curves) {
    std::vector<std::string> cells = {"  " + curve.id};
    for (const study::CurvatureErrorScore& score : curve.scores) cells.push_back(cell(score));
    table.row(cells);
  }
  return title + "\n" + table.text();
}

// Error of the map against error of the curvature, and how much of the change a stated deviation of curvature
// accounts for.
std::string curvatureErrorText(const std::vector<study::CurvatureErrorCurve>& curves) {
  if (curves.empty()) return "";
  using Score = study::CurvatureErrorScore;
  const double none = std::numeric_limits<double>::quiet_NaN();
  return "\nError of the map against error of the curvature: five_sections, trained with the right "
         "curvatures, told wrong ones\n" +
         errorTable("RMSE [" + settings::shownUnitName() + "]", curves,
                    [](const Score& score) { return inShownUnit(score.rmse); }) +
         errorTable("RMSE [% of range]", curves,
                    [](const Score& score) { return settings::fixedText(score.rmse_percent, 2); }) +
         errorTable(
             "Stated: what the map's deviation takes up where the message states the error as its deviation "
             "[% of the change of the pressures]",
             curves, [&](const Score& score) {
               return settings::fixedText(score.moved > 0 ? 100 * score.stated / score.moved : none, 0);
             });
}

}  // namespace

std::string studyText(const study::StudyResult& result) {
  std::string text = std::to_string(result.scans) + " scans of " + std::to_string(result.taxels.size()) +
                     " taxels on " + std::to_string(result.classes.size()) + " conditions, " +
                     std::to_string(result.cycles) + " cycles, " + std::to_string(result.mounts) +
                     " mounts\n" + linesOf(result.warnings, "Warning: ");
  for (const study::StudyComparison& comparison : result.comparisons)
    text += comparisonText(comparison, result.layout);
  if (!result.plan.beyond_the_paper) return text + '\n' + linesOf(result.holds_for, "");
  text += "\nAll scans, bandwidth chosen by nested cross-validation: RMSE with 95 % interval\n";
  for (const study::SplitResult& split : result.splits) {
    text += splitText(split);
    if (split.scores.back().id == "history") text += historyChoiceText(result.history);
  }
  if (result.history.protocols.empty()) text += "\nhistory: " + result.history.choice + '\n';
  return text + curvatureErrorText(result.curvature_errors) + '\n' + result.headline.text + '\n' +
         linesOf(result.holds_for, "");
}

}  // namespace fsr::report
