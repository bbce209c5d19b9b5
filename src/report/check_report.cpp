#include "report/check_report.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "calibration/stages/deviation/new_mount_line.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "report/calibration_report.h"
#include "report/result_json.h"
#include "report/text_table.h"
#include "settings/number_text.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"

namespace fsr::report {

namespace {

using settings::fixedPressure;
using settings::fixedText;
using settings::roundedText;

constexpr const char* kModelNames[check::kChangeModels] = {"none", "whole sheet", "by taxel"};

void addRow(const check::CheckedReadings& row, std::size_t width, std::ostringstream& out) {
  const auto cell = [&](int cell_width, double value) {
    out << std::setw(cell_width) << fixedText(value, 1);
  };
  out << std::left << std::setw(static_cast<int>(width)) << (row.name.empty() ? "all" : row.name)
      << std::right << std::setw(12) << row.readings;
  cell(14, row.expectedRmse() / settings::shownUnitSize());
  cell(11, row.rmse() / settings::shownUnitSize());
  cell(11, row.bias() / settings::shownUnitSize());
  cell(14, 100 * row.share(row.within));
  cell(12, 100 * row.share(row.beyond));
  out << '\n';
}

void addErrors(const check::MapErrors& errors, std::ostringstream& out) {
  std::size_t width = 8;
  const std::string unit = '[' + settings::shownUnitName() + ']';
  for (const check::CheckedReadings& row : errors.surfaces) width = std::max(width, row.name.size() + 2);
  out << std::left << std::setw(static_cast<int>(width)) << "surface" << std::right << std::setw(12)
      << "readings" << std::setw(14) << "expected" << std::setw(11) << "RMSE" << std::setw(11) << "bias"
      << std::setw(14) << "within" << std::setw(12) << "outside" << '\n'
      << std::setw(static_cast<int>(width) + 26) << "RMSE " + unit << std::setw(11) << unit << std::setw(11)
      << unit << std::setw(14) << "1 deviation %" << std::setw(12) << "training %" << '\n';
  for (const check::CheckedReadings& row : errors.surfaces) addRow(row, width, out);
  addRow(errors.whole, width, out);
  out << historyTable(errors.history);
}

const char* shapeVerdict(calibration::ShapeVerdict verdict) {
  if (verdict == calibration::ShapeVerdict::kAgrees) return "agrees";
  return verdict == calibration::ShapeVerdict::kDisagrees ? "disagrees" : "unknown";
}

std::string namesText(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + (name.empty() ? "?" : name);
  return text.empty() ? "-" : text;
}

std::string declaredCurvature(const matrix::Surface& surface) {
  if (surface.curvature.size() > 1) return "varies";
  return fixedText(matrix::principalCurvature(surface.curvature.front()), 2);
}

// "8.0 +- 0.8", or "-" if the readings do not bound it.
std::string changeText(const calibration::ShapeModel& model, const calibration::BendChange& change) {
  if (!calibration::isKnown(model, change)) return "-";
  return fixedText(change.change, 2) + " +- " + fixedText(change.deviation, 2);
}

std::string changeTable(const calibration::ShapeModel& model,
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

std::string shapeText(const calibration::ShapeModel& model,
                      const std::vector<calibration::CheckedMount>& mounts) {
  if (mounts.empty())
    return "How the sheet lies cannot be told: no bag starts with a rest before the first load\n";
  TextTable table(
      {"mount", "declared", "rests as", "low", "high", "verdict", "surfaces of training that agree"}, {5, 6});
  std::string sentences;
  for (const auto& [mount, check] : mounts) {
    const auto number = [estimated = check.estimated](double value) {
      return estimated ? fixedText(value, 2) : "-";
    };
    table.row({mount.name, declaredCurvature(mount.surface), number(check.estimate.curvature),
               number(check.estimate.low), number(check.estimate.high), shapeVerdict(check.verdict),
               namesText(check.possible)});
    if (check.verdict != calibration::ShapeVerdict::kAgrees)
      sentences += mount.name + ": " + check.sentence + '\n';
  }
  return "How the sheet rests before the first load: principal curvature [1/m]\n" + table.text() +
         changeTable(model, mounts) + sentences;
}

// "-5.0 to +1.2"; "-5.0" where all taxels have that.
std::string spanText(const std::vector<check::ReadingChange>& changes,
                     double (*value)(const check::ReadingChange&)) {
  const auto [low, high] = std::minmax_element(
      changes.begin(), changes.end(), [&](const auto& a, const auto& b) { return value(a) < value(b); });
  const auto text = [&](const check::ReadingChange& one) {
    return (value(one) > 0 ? "+" : "") + fixedText(value(one), 1);
  };
  return text(*low) == text(*high) ? text(*low) : text(*low) + " to " + text(*high);
}

// "3 mounts have 12.3 kPa in common; mounts scatter by 1.2 kPa (2 degrees of freedom), p = 0.01".
std::string mountsText(const check::MountTest& test) {
  const check::CommonChange& sheet = test.sheet;
  std::string text = std::to_string(test.mounts) + (test.mounts == 1 ? " mount has " : " mounts have ") +
                     fixedPressure(sheet.size, 1) + " in common; ";
  if (!sheet.scatter.known()) return text + "how much mounts scatter is not known";
  return text + "mounts scatter by " + fixedPressure(sheet.scatter.deviation, 1) + " (" +
         std::to_string(sheet.scatter.freedom) + " degrees of freedom), p = " + roundedText(sheet.p, 3);
}

void addCorrection(const check::CorrectionCheck& correction, std::ostringstream& out) {
  const check::CorrectionChoice& choice = correction.choice;
  out << correction.cycles << " cycles on ";
  for (const std::string& surface : correction.surfaces)
    out << (&surface == &correction.surfaces.front() ? "" : ", ") << surface;
  out << "; expected RMSE of the map " << fixedPressure(correction.expected, 1) << ", of the tables alone "
      << fixedPressure(choice.expected, 1)
      << "\nRMSE of the tables alone on cycles that were left out: without correction "
      << fixedPressure(choice.rmse[0], 1);
  for (std::size_t m = 1; m < check::kChangeModels; ++m)
    out << ", " << kModelNames[m] << ' ' << fixedPressure(choice.rmse[m], 1);
  out << "; chosen without each cycle " << fixedPressure(choice.nested, 1) << " (p "
      << (choice.p < 1e-4 ? "< 0.0001" : "= " + roundedText(choice.p, 2)) << ")\n";
  if (choice.model != check::ChangeModel::kNone && !choice.changes.empty()) {
    out << "Best: " << kModelNames[static_cast<std::size_t>(choice.model)] << ", gain "
        << spanText(choice.changes, [](const check::ReadingChange& one) { return 100 * (one.gain - 1); })
        << " %, offset "
        << spanText(choice.changes, [](const check::ReadingChange& one) { return one.offset; })
        << " counts\n";
  }
  if (correction.mounts) out << "Whole sheet: " << mountsText(*correction.mounts) << '\n';
  for (const std::string& remark : correction.remarks) out << "Note: " << remark << '\n';
}

std::string nextStep(const check::CheckResult& result) {
  switch (result.verdict) {
    case check::Verdict::kStillGood:
      return result.map.not_shown.empty() ? "use it" : "use it, and check it on bags that show the rest";
    case check::Verdict::kCorrected:
      return "use the corrected calibration";
    case check::Verdict::kCannotTell:
      return "record more mounts";
    case check::Verdict::kTare:
      return "tare the unloaded sheet at the start of each session (~tare)";
    case check::Verdict::kRecalibrate:
      break;
  }
  return result.correction ? "train again with these bags"
                           : "ask check_calibration --correct whether gain and offset are enough, or train "
                             "again with these "
                             "bags";
}

// What the map is good for on these bags, and the worst of them.
std::string goodFor(const check::CheckResult& result) {
  const check::MapErrors& map = result.map;
  const auto worst = std::max_element(map.bags.begin(), map.bags.end(),
                                      [](const auto& a, const auto& b) { return a.rmse() < b.rmse(); });
  const std::string bag = worst == map.bags.end()
                              ? ""
                              : "; worst bag: " + worst->name + ", RMSE " + fixedPressure(worst->rmse(), 1);
  return "Good for: 68 % of the readings of these bags err by at most " +
         calibration::errorText(map.within[0], map.range) + " and 95 % by at most " +
         calibration::errorText(map.within[1], map.range) + bag + "; next: " + nextStep(result) + "\n";
}

std::string verdictText(const check::CheckResult& result) {
  std::string text = check::verdictName(result.verdict);
  text.front() = static_cast<char>(text.front() - 'a' + 'A');
  const bool good = result.verdict == check::Verdict::kStillGood;
  if (good && !result.map.not_shown.empty()) text += " as far as these bags show";
  if (result.reasons.empty()) return text + ".\n";
  text += result.verdict == check::Verdict::kRecalibrate ? ", because" : ":";
  for (const std::string& reason : result.reasons)
    text += (result.reasons.size() == 1 ? " " : "\n  - ") + reason;
  return text + '\n';
}

Json changeJson(const check::CommonChange& change) {
  return {{"common_pa", change.size},
          {"mount_scatter_pa", change.scatter.deviation},
          {"degrees_of_freedom", change.scatter.freedom},
          {"p", change.p}};
}

// Without `mounts` (null): they were not asked.
void addJson(const check::CorrectionCheck& correction, Json& document) {
  const check::CorrectionChoice& choice = correction.choice;
  document["cycles"] = correction.cycles;
  document["surfaces"] = correction.surfaces;
  document["best"] = kModelNames[static_cast<std::size_t>(choice.model)];
  Json gain = Json::array(), offset = Json::array();
  for (const check::ReadingChange& change : choice.changes) {
    gain.push_back(change.gain);
    offset.push_back(change.offset);
  }
  document["gain"] = gain;
  document["offset_counts"] = offset;
  document["rmse_pa"] = {
      {"expected_of_map", correction.expected}, {"expected", choice.expected}, {"none", choice.rmse[0]},
      {"whole_sheet", choice.rmse[1]},          {"by_taxel", choice.rmse[2]},  {"nested", choice.nested}};
  document["p"] = choice.p;
  document["mounts"] = nullptr;
  if (!correction.mounts) return;
  document["mounts"] = {{"number", correction.mounts->mounts},
                        {"sheet", changeJson(correction.mounts->sheet)},
                        {"taxels", changeJson(correction.mounts->taxels)}};
}

}  // namespace

std::string checkText(const check::CheckResult& result, const calibration::Calibration& calibration) {
  std::ostringstream out;
  if (result.child) out << "Errors of the corrected calibration:\n";
  addErrors(result.map, out);
  if (calibration.shape.present()) {
    out << shapeText(calibration.shape, result.at_rest);
  } else {
    out << "How the sheet rests is not known: " << calibration.shape.missing << '\n';
  }
  if (result.correction) addCorrection(*result.correction, out);
  for (const std::string& remark : result.map.remarks) out << "Note: " << remark << '\n';
  for (const std::string& sentence : result.map.not_shown) out << "Not shown: " << sentence << '\n';
  out << goodFor(result) << verdictText(result);
  return out.str();
}

namespace {

std::string checkJson(const check::CheckResult& result, const std::string& parent, const std::string& child) {
  Json document = {{"verdict", check::verdictName(result.verdict)},
                   {"reasons", result.reasons},
                   {"remarks", result.correction ? result.correction->remarks : result.map.remarks},
                   {"parent", parent},
                   {"child", child.empty() ? Json(nullptr) : Json(child)}};
  if (result.correction) addJson(*result.correction, document);
  return dump(document);
}

}  // namespace

void requireCheckOutputs(const CheckOutputs& outputs) {
  namespace kind = settings::file_kind;
  if (!outputs.calibration.empty()) settings::requireReplaceable(outputs.calibration, kind::kCalibration);
  if (!outputs.report.empty()) settings::requireReplaceable(outputs.report, kind::kJson);
}

std::string writeCheck(const check::CheckResult& result, const std::string& parent,
                       const CheckOutputs& outputs) {
  std::string text, child;
  if (result.child && !outputs.calibration.empty()) {
    child = calibration::saveCalibration(*result.child, outputs.calibration);
    text = "Calibration " + child + " (" + check::correctionText(result.child->correction) + ") written to " +
           settings::fullPath(outputs.calibration) + '\n';
  } else if (!outputs.calibration.empty()) {
    text = "No calibration was written to " + settings::fullPath(outputs.calibration) + '\n';
  }
  if (outputs.report.empty()) return text;
  settings::replaceFile(outputs.report, checkJson(result, parent, child));
  return text + "Report written to " + settings::fullPath(outputs.report) + '\n';
}

}  // namespace fsr::report
