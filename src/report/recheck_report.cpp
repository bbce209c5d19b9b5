#include "report/recheck_report.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "report/result_json.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

using calibration::ChangeModel;
using calibration::ReadingChange;

std::string signedText(double value, int decimals) {
  return (value > 0 ? "+" : "") + settings::fixedText(value, decimals);
}

std::string modelName(ChangeModel model) {
  switch (model) {
    case ChangeModel::kNone:
      return "none";
    case ChangeModel::kSheet:
      return "whole sheet";
    case ChangeModel::kTaxels:
      return "by taxel";
  }
  return "";
}

template <typename Value>
std::pair<double, double> rangeOf(const std::vector<ReadingChange>& changes, Value value) {
  double low = value(changes.front()), high = low;
  for (const ReadingChange& change : changes) {
    low = std::min(low, value(change));
    high = std::max(high, value(change));
  }
  return {low, high};
}

std::string spanText(std::pair<double, double> range, int decimals) {
  const std::string low = signedText(range.first, decimals), high = signedText(range.second, decimals);
  return low == high ? low : low + " to " + high;
}

// "gain -5.0 %, offset +18.2 counts".
std::string changeText(const std::vector<ReadingChange>& changes) {
  if (changes.empty()) return "none";
  const auto gain = rangeOf(changes, [](const ReadingChange& one) { return 100 * (one.gain - 1); });
  const auto offset = rangeOf(changes, [](const ReadingChange& one) { return one.offset; });
  return "gain " + spanText(gain, 1) + " %, offset " + spanText(offset, 1) + " counts";
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

Json changeJson(const calibration::CommonChange& change) {
  return {{"common_pa", change.size},
          {"mount_scatter_pa", change.scatter.deviation},
          {"degrees_of_freedom", change.scatter.freedom},
          {"p", change.p}};
}

// null = mounts were not asked.
Json mountsJson(const calibration::Recheck& recheck) {
  if (!recheck.mounts) return nullptr;
  return {{"number", recheck.mounts->mounts},
          {"sheet", changeJson(recheck.mounts->sheet)},
          {"taxels", changeJson(recheck.mounts->taxels)}};
}

// "3 mounts have 12.3 kPa in common and scatter by 1.2 kPa (2 degrees of freedom): p = 0.01".
std::string mountsText(const calibration::MountTest& test) {
  const calibration::CommonChange& sheet = test.sheet;
  std::string text = std::to_string(test.mounts) + (test.mounts == 1 ? " mount has " : " mounts have ") +
                     settings::fixedKilopascals(sheet.size, 1) + " in common; ";
  if (!sheet.scatter.known()) return text + "how much mounts scatter is not known";
  return text + "mounts scatter by " + settings::fixedKilopascals(sheet.scatter.deviation, 1) + " (" +
         std::to_string(sheet.scatter.freedom) +
         " degrees of freedom), p = " + settings::roundedText(sheet.p, 3);
}

}  // namespace

std::string recheckText(const calibration::Recheck& recheck) {
  const calibration::CorrectionChoice& choice = recheck.choice;
  std::ostringstream out;
  out << recheck.cycles << " cycles on " << listed(recheck.surfaces) << "; expected RMSE of the map "
      << settings::fixedKilopascals(recheck.expected, 1) << ", of the tables alone "
      << settings::fixedKilopascals(choice.expected, 1)
      << "\nRMSE of the tables alone on cycles that were left out:";
  for (std::size_t m = 0; m < calibration::kChangeModels; ++m) {
    out << (m == 0 ? " without correction " : ", ")
        << (m == 0 ? "" : modelName(static_cast<ChangeModel>(m)) + " ")
        << settings::fixedKilopascals(choice.rmse[m], 1);
  }
  out << "; chosen without each cycle " << settings::fixedKilopascals(choice.nested, 1) << " (p "
      << (choice.p < 1e-4 ? "< 0.0001" : "= " + settings::roundedText(choice.p, 2)) << ")\n";
  if (choice.model != ChangeModel::kNone)
    out << "Best: " << modelName(choice.model) << ", " << changeText(choice.changes) << '\n';
  if (recheck.mounts) out << "Whole sheet: " << mountsText(*recheck.mounts) << '\n';
  for (const std::string& remark : recheck.remarks) out << "Note: " << remark << '\n';
  for (const std::string& remark : recheck.check.remarks) out << "Note: " << remark << '\n';
  std::string verdict = calibration::verdictName(recheck.verdict);
  verdict.front() = static_cast<char>(verdict.front() - 'a' + 'A');
  out << verdict << ':';
  for (const std::string& reason : recheck.reasons)
    out << (recheck.reasons.size() == 1 ? " " : "\n  - ") << reason;
  out << '\n';
  return out.str();
}

std::string recheckJson(const calibration::Recheck& recheck, const std::string& parent,
                        const std::string& child) {
  const calibration::CorrectionChoice& choice = recheck.choice;
  Json gain = Json::array(), offset = Json::array();
  for (const ReadingChange& change : choice.changes) {
    gain.push_back(change.gain);
    offset.push_back(change.offset);
  }
  const Json document = {{"verdict", calibration::verdictName(recheck.verdict)},
                         {"reasons", recheck.reasons},
                         {"remarks", recheck.remarks},
                         {"parent", parent},
                         {"child", child.empty() ? Json(nullptr) : Json(child)},
                         {"cycles", recheck.cycles},
                         {"surfaces", recheck.surfaces},
                         {"best", modelName(choice.model)},
                         {"gain", gain},
                         {"offset_counts", offset},
                         {"rmse_pa",
                          {{"expected_of_map", recheck.expected},
                           {"expected", choice.expected},
                           {"none", choice.rmse[0]},
                           {"whole_sheet", choice.rmse[1]},
                           {"by_taxel", choice.rmse[2]},
                           {"nested", choice.nested}}},
                         {"p", choice.p},
                         {"mounts", mountsJson(recheck)}};
  return dump(document);
}

}  // namespace fsr::report
