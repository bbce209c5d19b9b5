#include "report/calibration_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "settings/number_text.h"

namespace fsr::report {

namespace {

constexpr int kNameWidth = 18;
constexpr int kCellWidth = 14;

std::string kilopascal(double pressure) {
  return settings::fixedText(pressure / 1e3, 1);
}

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

void nameCell(std::ostream& out, const std::string& name) {
  out << std::left << std::setw(kNameWidth) << (name.empty() ? "(no name)" : name) << ' ' << std::right;
}

void cell(std::ostream& out, const std::string& text, int width = kCellWidth) {
  out << std::setw(width) << text;
}

void binHeads(std::ostream& out) {
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
    cell(out, statistics::pressureBinName(bin) + " kPa");
  out << '\n';
}

void coverageRow(std::ostream& out, const dataset::ConditionCoverage& row) {
  nameCell(out, row.condition.surface);
  cell(out, curvature(row.condition, 1.0, 2), 12);
  cell(out, curvature(row.condition, 100.0, 3), 12);
  cell(out, std::to_string(row.scans), 8);
  cell(out, std::to_string(row.cycles), 7);
  cell(out, row.mounts.empty() ? "-" : std::to_string(row.mounts.size()), 7);
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin) {
    cell(out, std::to_string(row.loading[bin].scans) + "/" + std::to_string(row.unloading[bin].scans));
  }
  out << '\n';
}

void scoreRow(std::ostream& out, const std::string& name, const calibration::Score& score,
              const matrix::Layout& layout) {
  const statistics::ErrorSummary& errors = score.errors.whole.all;
  nameCell(out, name);
  cell(out, spread(score.r2, 4), 20);
  cell(out, spread(score.rmse_percent, 2), 16);
  cell(out, kilopascal(errors.rmse), 8);
  cell(out, kilopascal(errors.bias), 8);
  cell(out, kilopascal(errors.limit_low) + ".." + kilopascal(errors.limit_high), 16);
  cell(out, kilopascal(errors.p95_absolute), 8);
  cell(out,
       settings::fixedText(score.worst_rmse_percent, 2) + " (" +
           std::to_string(layout.row({score.worst_taxel})) + ", " +
           std::to_string(layout.column({score.worst_taxel})) + ")",
       16);
  cell(out, settings::percentText(score.within_one_deviation), 13);
  out << '\n';
}

void binRow(std::ostream& out, const std::string& name, const calibration::Score& score) {
  nameCell(out, name);
  for (const statistics::BinnedErrors::Directions& bin : score.errors.bins) {
    cell(out, kilopascal(bin.loading.rmse) + "/" + kilopascal(bin.unloading.rmse));
  }
  out << '\n';
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
  std::ostringstream out;
  out << "Coverage: number of scans during loading/unloading, by gauge pressure\n";
  nameCell(out, "surface");
  cell(out, "1/m", 12);
  cell(out, "1/cm", 12);
  cell(out, "scans", 8);
  cell(out, "cycles", 7);
  cell(out, "mounts", 7);
  binHeads(out);
  for (const dataset::ConditionCoverage& row : coverage.conditions) coverageRow(out, row);
  out << (coverage.thin.empty() ? "Coverage is complete.\n" : "Few or no data:\n");
  for (const std::string& sentence : coverage.thin) out << "  " << sentence << '\n';
  return out.str();
}

std::string scoresText(const calibration::CalibrationScores& scores, const matrix::Layout& layout) {
  if (scores.conditions.empty()) return "Scores were not computed.\n";
  std::ostringstream out;
  out << "Held-out readings, predicted without their section; R2 and RMSE%: mean +- standard deviation over "
         "taxels\n";
  nameCell(out, "surface");
  cell(out, "R2", 20);
  cell(out, "RMSE%", 16);
  cell(out, "RMSE", 8);
  cell(out, "bias", 8);
  cell(out, "95 % limits", 16);
  cell(out, "p95", 8);
  cell(out, "worst taxel", 16);
  cell(out, "within 1 dev", 13);
  out << '\n';
  nameCell(out, " ");
  cell(out, "", 36);
  cell(out, "kPa", 8);
  cell(out, "kPa", 8);
  cell(out, "kPa", 16);
  cell(out, "kPa", 8);
  cell(out, "% (row, col.)", 16);
  out << '\n';
  forEachRow(scores, [&](const std::string& name, const calibration::Score& score) {
    scoreRow(out, name, score, layout);
  });
  out << "RMSE [kPa] during loading/unloading\n";
  nameCell(out, "surface");
  binHeads(out);
  forEachRow(scores,
             [&](const std::string& name, const calibration::Score& score) { binRow(out, name, score); });
  const auto untrained = [](const calibration::ConditionScore& condition) { return !condition.trained; };
  out << unseenText(scores.unseen);
  if (scores.remount.readings > 0) {
    out << "Another mount (each mount left out in turn; part of the stated deviation): RMSE "
        << kilopascal(scores.remount.rmse) << " kPa, " << spread(scores.remount.rmse_percent, 2) << " %\n";
  } else {
    out << "Another mount: not assessed, because no surface was mounted more than once. Errors after putting "
           "the matrix on again\nare larger than those above and than the stated deviation. Record each "
           "surface on two mounts or more.\n";
  }
  if (std::any_of(scores.conditions.begin(), scores.conditions.end(), untrained)) {
    out << "* the model used for this surface was not trained on it\n";
  }
  return out.str();
}

std::string unseenText(const calibration::UnseenScore& score) {
  if (score.readings == 0) return "";
  return "Curvature not used for training (each inner surface left out in turn): RMSE " +
         kilopascal(score.rmse) + " kPa, " + spread(score.rmse_percent, 2) + " %\n";
}

std::string warningsText(const calibration::Calibration& calibration) {
  std::string text;
  for (const std::string& warning : calibration.warnings) text += "Warning: " + warning + '\n';
  return text;
}

std::string learnedText(const calibration::Calibration& calibration) {
  const compensation::CurvatureTables& tables = calibration.tables;
  std::ostringstream text;
  if (tables.scheme == compensation::Scheme::kScaledCurvature && !tables.rule.length_scale.empty()) {
    text << "Length scale of curvature: " << settings::roundedText(tables.rule.length_scale.front(), 3)
         << " 1/m\n";
  }
  if (tables.scheme == compensation::Scheme::kCurvatureRanges) {
    text << "Curvature ranges: ";
    const std::vector<std::size_t>& model = tables.rule.model_of_class;
    for (std::size_t k = 0; k < tables.classes.size(); ++k) {
      const bool same = k > 0 && !model.empty() && model[k] == model[k - 1];
      text << (k == 0 ? "" : same ? ", " : "; ") << tables.classes[k].surface;
    }
    text << '\n';
  }
  return text.str();
}

std::string modelText(const calibration::Calibration& calibration) {
  const regression::RegressorOptions& model = calibration.regressor;
  if (model.name != "grnn") return model.name;
  return model.name + ", bandwidth " + settings::roundedText(model.grnn.bandwidth, 3) +
         (calibration.bandwidth_chosen ? " (chosen)" : "");
}

}  // namespace fsr::report
