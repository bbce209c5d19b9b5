#include "report/shape_report.h"

#include "report/text_table.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

using calibration::ShapeVerdict;

const char* verdictName(ShapeVerdict verdict) {
  if (verdict == ShapeVerdict::kAgrees) return "agrees";
  return verdict == ShapeVerdict::kDisagrees ? "disagrees" : "unknown";
}

std::string namesText(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + (name.empty() ? "?" : name);
  return text.empty() ? "-" : text;
}

std::string declaredCurvature(const matrix::Surface& surface) {
  if (surface.curvature.size() > 1) return "varies";
  return settings::fixedText(matrix::principalCurvature(surface.curvature.front()), 2);
}

// "8.0 +- 0.8", or "-" if the readings do not bound it.
std::string changeText(const compensation::ShapeModel& model, const compensation::BendChange& change) {
  if (!calibration::isKnown(model, change)) return "-";
  return settings::fixedText(change.change, 2) + " +- " + settings::fixedText(change.deviation, 2);
}

std::string changeTable(const compensation::ShapeModel& model,
                        const std::vector<calibration::CheckedMount>& mounts) {
  TextTable table({"mount", "along a row", "along a column", "changes"}, {1, 2, 3});
  for (const auto& [mount, check] : mounts) {
    if (check.estimate.taxels == 0) continue;  // no estimate was made
    table.row({mount.name, changeText(model, check.change.along_x), changeText(model, check.change.along_y),
               check.changes ? "yes" : "no"});
  }
  return "\nChange of the bend along the sheet, from the first to the last column and row [1/m]; - = not "
         "known\n" +
         table.text() + calibration::fixedText(model) + "\n\n";
}

}  // namespace

std::string shapeText(const compensation::ShapeModel& model,
                      const std::vector<calibration::CheckedMount>& mounts) {
  if (mounts.empty())
    return "How the sheet lies cannot be told: no bag starts with a rest before the first load\n";
  TextTable table(
      {"mount", "declared", "rests as", "low", "high", "verdict", "surfaces of training that agree"}, {5, 6});
  std::string sentences;
  for (const auto& [mount, check] : mounts) {
    const auto number = [estimated = check.estimated](double value) {
      return estimated ? settings::fixedText(value, 2) : "-";
    };
    table.row({mount.name, declaredCurvature(mount.surface), number(check.estimate.curvature),
               number(check.estimate.low), number(check.estimate.high), verdictName(check.verdict),
               namesText(check.possible)});
    if (check.verdict != ShapeVerdict::kAgrees) sentences += mount.name + ": " + check.sentence + '\n';
  }
  return "How the sheet rests before the first load: principal curvature [1/m]\n" + table.text() +
         changeTable(model, mounts) + sentences;
}

}  // namespace fsr::report
