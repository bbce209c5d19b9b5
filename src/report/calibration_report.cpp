#include "report/calibration_report.h"

#include <algorithm>
#include <cmath>

#include "calibration/stages/deviation/new_mount_line.h"
#include "report/text_table.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

constexpr int kDecimals = 2;  // of an error [kPa]

std::string protocolTable(const std::vector<calibration::HistoryScore::Protocol>& protocols) {
  TextTable table({"protocol", "static", "plays", "memories", "both", "c alone"});
  for (const auto& protocol : protocols) {
    std::vector<std::string> cells = {protocol.name};
    for (const double rmse : protocol.rmse) cells.push_back(inShownUnit(rmse, kDecimals));
    cells.push_back(inShownUnit(protocol.corrected_rmse, kDecimals));
    table.row(cells);
  }
  return "RMSE [" + settings::shownUnitName() +
         "] of means over half a second; each protocol was predicted without it\n" + table.text();
}

}  // namespace

std::string historyTable(const std::vector<calibration::HistoryScore::Part>& parts) {
  if (parts.empty()) return "";
  TextTable table({"readings", "static", "history", "within 1 dev", "number"});
  for (const auto& part : parts)
    table.row({part.name, inShownUnit(part.static_rmse, kDecimals), inShownUnit(part.rmse, kDecimals),
               settings::percentText(part.within_one_deviation), std::to_string(part.readings)});
  return "RMSE [" + settings::shownUnitName() +
         "] of the static answer and with the history, by part of the readings\n" + table.text();
}

std::string historyChoiceText(const calibration::HistoryScore& score) {
  return score.choice + '\n' + (score.protocols.empty() ? "" : protocolTable(score.protocols));
}

std::string historyText(const calibration::Calibration& calibration) {
  const calibration::HistoryScore& score = calibration.scores.history;
  if (score.choice.empty()) return "";
  return historyChoiceText(score) +
         (score.parts.empty() ? "" : "Protocols that were left out. " + historyTable(score.parts));
}

std::string temperatureText(const calibration::Calibration& calibration) {
  const calibration::TemperatureScore& score = calibration.scores.temperature;
  if (score.choice.empty()) return "";
  std::string text = score.choice + '\n';
  if (calibration.temperature.present())
    text += "Tables, scores and history are those of " +
            settings::roundedText(calibration.temperature.reference, 3) + " degrees Celsius.\n";
  if (score.groups.empty()) return text;
  TextTable table({"left out", "without temperature", "with"});
  for (const auto& group : score.groups)
    table.row({group.name, inShownUnit(group.without, kDecimals), inShownUnit(group.with, kDecimals)});
  return text + "RMSE of readings [" + settings::shownUnitName() +
         " on a straight line up to the highest pressure]; each protocol and recording was predicted without "
         "it\n" +
         table.text();
}

std::string sessionText(const calibration::SessionScore& score) {
  if (score.choice.empty()) return "";
  if (score.sessions.empty()) return score.choice + '\n';
  TextTable table({"session", "static", "tared", "trained and tared", "number"});
  for (const auto& session : score.sessions)
    table.row({session.name, inShownUnit(session.rmse[0], kDecimals), inShownUnit(session.rmse[1], kDecimals),
               inShownUnit(session.rmse[2], kDecimals), std::to_string(session.readings)});
  return score.choice + "\nRMSE [" + settings::shownUnitName() +
         "] after the rest at the start; each session was predicted without it\n" + table.text();
}

namespace {

std::string spread(const statistics::Spread& value, int digits) {
  return std::isnan(value.deviation) ? settings::fixedText(value.mean, digits)
                                     : settings::fixedText(value.mean, digits) + " +- " +
                                           settings::fixedText(value.deviation, digits);
}

// "14.3" if all taxels have the same curvature, else "9.0..14.3".
std::string curvature(const dataset::CurvatureClass& condition, double unit, int digits) {
  const auto [low, high] = std::minmax_element(condition.curvature.begin(), condition.curvature.end());
  const std::string first = settings::fixedText(*low / unit, digits);
  return *low == *high ? first : first + ".." + settings::fixedText(*high / unit, digits);
}

std::string nameText(const std::string& name) {
  return name.empty() ? "(no name)" : name;
}

// Headings, then one for each pressure bin.
std::vector<std::string> withBins(std::vector<std::string> headings) {
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
    headings.push_back(binText(bin) + ' ' + settings::shownUnitName());
  return headings;
}

std::vector<std::string> coverageRow(const dataset::ConditionCoverage& row) {
  std::vector<std::string> cells = {
      nameText(row.condition.surface),    curvature(row.condition, 1.0, 2),
      curvature(row.condition, 100.0, 3), std::to_string(row.scans),
      std::to_string(row.cycles),         row.mounts.empty() ? "-" : std::to_string(row.mounts.size())};
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
    cells.push_back(std::to_string(row.loading[bin].scans) + "/" + std::to_string(row.unloading[bin].scans));
  return cells;
}

std::vector<std::string> scoreRow(const std::string& name, const calibration::Score& score,
                                  const matrix::Layout& layout) {
  const statistics::ErrorSummary& errors = score.errors.whole.all;
  return {nameText(name),
          spread(score.r2, 4),
          spread(score.rmse_percent, 2),
          inShownUnit(errors.rmse),
          inShownUnit(errors.bias),
          inShownUnit(errors.limit_low) + ".." + inShownUnit(errors.limit_high),
          inShownUnit(errors.p95_absolute),
          settings::fixedText(score.worst_rmse_percent, 2) + " (" +
              std::to_string(layout.row({score.worst_taxel})) + ", " +
              std::to_string(layout.column({score.worst_taxel})) + ")",
          settings::percentText(score.within_one_deviation)};
}

std::vector<std::string> binRow(const std::string& name, const calibration::Score& score) {
  std::vector<std::string> cells = {nameText(name)};
  for (const statistics::BinnedErrors::Directions& bin : score.errors.bins)
    cells.push_back(inShownUnit(bin.loading.rmse) + "/" + inShownUnit(bin.unloading.rmse));
  return cells;
}

template <typename Row>
void forEachRow(const calibration::CalibrationScores& scores, Row row) {
  for (const calibration::ConditionScore& condition : scores.conditions) {
    row(condition.condition.surface + (condition.trained ? "" : " *"), condition.score);
  }
  row("all together", scores.whole);
}

}  // namespace

std::string coverageText(const dataset::Coverage& coverage) {
  TextTable table(withBins({"surface", "1/m", "1/cm", "scans", "cycles", "mounts"}));
  for (const dataset::ConditionCoverage& row : coverage.conditions) table.row(coverageRow(row));
  return "Coverage: number of scans during loading/unloading, by gauge pressure\n" + table.text() +
         (coverage.thin.empty() ? "Coverage is complete.\n" : "Few or no data:\n") +
         linesOf(coverage.thin, "  ");
}

std::string scoresText(const calibration::CalibrationScores& scores, const matrix::Layout& layout) {
  if (scores.conditions.empty()) return "Scores were not computed.\n";
  TextTable table(
      {"surface", "R2", "RMSE%", "RMSE", "bias", "95 % limits", "p95", "worst taxel", "within 1 dev"});
  const std::string unit = settings::shownUnitName();
  table.row({"", "", "", unit, unit, unit, unit, "% (row, col.)"});
  TextTable bins(withBins({"surface"}));
  bool untrained = false;
  forEachRow(scores, [&](const std::string& name, const calibration::Score& score) {
    table.row(scoreRow(name, score, layout));
    bins.row(binRow(name, score));
  });
  for (const calibration::ConditionScore& condition : scores.conditions) untrained |= !condition.trained;
  const std::string remount =
      scores.remount.readings > 0
          ? "Another mount (each mount left out in turn; part of the stated deviation): RMSE " +
                settings::fixedPressure(scores.remount.rmse, 1) + ", " +
                spread(scores.remount.rmse_percent, 2) + " %\n"
          : "Another mount: not assessed, because no surface was mounted more than once. Errors after "
            "putting "
            "the matrix on again\nare larger than those above and than the stated deviation. Record each "
            "surface on two mounts or more.\n";
  return "Held-out readings, predicted without their section; R2 and RMSE%: mean +- standard deviation over "
         "taxels\n" +
         table.text() + "RMSE [" + unit + "] during loading/unloading\n" + bins.text() +
         unseenText(scores.unseen) + remount +
         (untrained ? "* the model used for this surface was not trained on it\n" : "");
}

std::string unseenText(const calibration::UnseenScore& score) {
  if (score.readings == 0) return "";
  return "Curvature not used for training (each inner surface left out in turn): RMSE " +
         settings::fixedPressure(score.rmse, 1) + ", " + spread(score.rmse_percent, 2) + " %\n";
}

std::string warningsText(const calibration::Calibration& calibration) {
  return linesOf(calibration.warnings, "Warning: ");
}

std::string learnedText(const calibration::Calibration& calibration) {
  const compensation::CurvatureTables& tables = calibration.tables;
  if (tables.scheme == compensation::Scheme::kScaledCurvature && !tables.rule.length_scale.empty())
    return "Length scale of curvature: " + settings::roundedText(tables.rule.length_scale.front(), 3) +
           " 1/m\n";
  if (tables.scheme != compensation::Scheme::kCurvatureRanges) return "";
  std::string text = "Curvature ranges: ";
  const std::vector<std::size_t>& model = tables.rule.model_of_class;
  for (std::size_t k = 0; k < tables.classes.size(); ++k) {
    const bool same = k > 0 && !model.empty() && model[k] == model[k - 1];
    text += (k == 0 ? "" : same ? ", " : "; ") + tables.classes[k].surface;
  }
  return text + '\n';
}

std::string modelText(const calibration::Calibration& calibration) {
  const regression::RegressorOptions& model = calibration.regressor;
  if (model.name != "grnn") return model.name;
  return model.name + ", bandwidth " + settings::roundedText(model.grnn.bandwidth, 3) +
         (calibration.bandwidth_chosen ? " (chosen)" : "");
}

namespace {

// Lines of each kind that a summary has at most. Together with the heading, the row of all surfaces, a line
// for each of four choices, one for new curvatures and one for the budget they are kSummaryLines.
constexpr std::size_t kSurfaces = 8;
constexpr std::size_t kNotes = 2;
constexpr std::size_t kWarnings = 3;
constexpr std::size_t kThin = 1;

// The first sentences, one a line, and how many more there are.
std::string firstOf(const std::string& head, const std::vector<std::string>& sentences, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, sentences.size()); ++i) {
    const std::size_t more = i + 1 == most ? sentences.size() - most : 0;
    text +=
        head + sentences[i] + (more > 0 ? " (and " + std::to_string(more) + " more: --details)" : "") + '\n';
  }
  return text;
}

std::string surfaceRows(const calibration::Calibration& calibration) {
  const std::vector<dataset::ConditionCoverage>& rows = calibration.coverage.conditions;
  const calibration::CalibrationScores& scores = calibration.scores;
  const std::string unit = settings::shownUnitName();
  TextTable table(
      {"Held-out readings", "scans", "cycles", "mounts", "RMSE " + unit, "RMSE %", "95 % within " + unit});
  const auto row = [&](const std::string& name, std::uint64_t scans, std::uint64_t cycles,
                       const std::string& mounts, const calibration::Score& score) {
    const statistics::ErrorSummary& errors = score.errors.whole.all;
    table.row({nameText(name), std::to_string(scans), std::to_string(cycles), mounts,
               inShownUnit(errors.rmse), settings::fixedText(score.rmse_percent.mean, 2),
               inShownUnit(errors.p95_absolute)});
  };
  std::uint64_t scans = 0, cycles = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    scans += rows[k].scans, cycles += rows[k].cycles;
    if (k >= kSurfaces) continue;
    row(rows[k].condition.surface, rows[k].scans, rows[k].cycles,
        rows[k].mounts.empty() ? "-" : std::to_string(rows[k].mounts.size()),
        k < scores.conditions.size() ? scores.conditions[k].score : calibration::Score{});
  }
  row(rows.size() > kSurfaces ? "all " + std::to_string(rows.size()) : "all together", scans, cycles, "",
      scores.whole);
  return table.text();
}

}  // namespace

std::string trainingSummary(const calibration::Calibration& calibration) {
  const calibration::CalibrationScores& scores = calibration.scores;
  std::string text = surfaceRows(calibration) +
                     firstOf("Few or no data: ", calibration.coverage.thin, kThin) +
                     firstOf("Note: ", calibration.provenance.conditioning, kNotes) +
                     firstOf("Warning: ", calibration.warnings, kWarnings) + unseenText(scores.unseen);
  for (const std::string& choice : {scores.session.choice, scores.temperature.choice, scores.history.choice})
    text += choice.empty() ? "" : choice + '\n';
  text += learnedText(calibration);
  if (!calibration.budget.present()) return text;
  text += "Combined standard uncertainty:";
  for (const double value : calibration.budget.combined) text += ' ' + inShownUnit(value);
  return text + ' ' + settings::shownUnitName() + " at 10, 50 and 90 % of the trained pressures\n";
}

std::string goodForText(const calibration::Calibration& calibration) {
  const std::string note = calibration::newMountNote(calibration.budget);
  return "Good for: " + (note.empty() ? "not known, because scores were not computed; next: train on all the "
                                        "bags without --no-scores"
                                      : note);
}

std::string trainingDetails(const calibration::Calibration& calibration) {
  return linesOf(calibration.provenance.conditioning, "Note: ") + warningsText(calibration) +
         scoresText(calibration.scores, calibration.layout) + sessionText(calibration.scores.session) +
         temperatureText(calibration) + historyText(calibration) + learnedText(calibration) +
         (calibration.budget.present() ? '\n' + budgetText(calibration.budget, calibration.layout) : "");
}

}  // namespace fsr::report
