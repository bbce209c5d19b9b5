#include <algorithm>
#include <cmath>

#include "report/discrepancy_report.h"
#include "report/result_json.h"
#include "report/text_table.h"
#include "settings/number_text.h"
#include "settings/text.h"

namespace fsr::report {

namespace {

constexpr int kDigits = 5;

using settings::fixedText;
using settings::percentText;

// "Common trace explained on each condition with sizes fitted to the others: 93 % (flat 95 %, bent 90 %)."
std::string foretoldLine(const discrepancy::HeldOutGap& held) {
  std::vector<std::string> parts;
  for (const auto& [part, closed] : held.parts) parts.push_back(part + " " + percentText(closed, 0));
  return "Common trace explained on each " + held.by +
         " with sizes fitted to the others: " + percentText(held.closed, 0) + " (" + settings::joined(parts) +
         ").\n";
}

// "On each surface: flat 0.95 % FS before, 0.20 % FS after; ..."
std::string surfacesLine(const discrepancy::DiscrepancyReport& report) {
  std::vector<std::string> parts;
  for (const discrepancy::SurfaceGap& one : report.gap.surfaces) {
    std::string part = one.surface + " " + percentText(one.before, 2) + " FS";
    if (!report.effects.empty()) part += " before, " + percentText(one.after, 2) + " FS after";
    parts.push_back(part);
  }
  return parts.size() < 2 ? "" : "On each surface: " + settings::joined(parts, "; ") + ".\n";
}

std::string notTestable(const discrepancy::DiscrepancyReport& report) {
  std::vector<std::string> effects;
  for (const discrepancy::NotIdentifiable& effect : report.not_identifiable) {
    const bool has_one = !effect.experiment.empty() && effect.experiment != "none";
    effects.push_back(effect.id + (has_one ? " (" + effect.experiment + ")" : ""));
  }
  return effects.empty() ? ""
                         : "Not testable here (what would show it): " + settings::joined(effects) + ".\n";
}

std::string opened(const std::vector<discrepancy::InputUse>& inputs) {
  int most = 0;
  for (const discrepancy::InputUse& input : inputs) most = std::max(most, input.hold_out_opened);
  return most > 1 ? "The hold-out part of a bag was used " + std::to_string(most) +
                        " times by now, so the gap is a weaker proof.\n"
                  : "";
}

std::string interval(const discrepancy::FittedParameter& parameter) {
  const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
  return yamlNumber(parameter.interval.low, kDigits) + " to " + yamlNumber(parameter.interval.high, kDigits) +
         unit;
}

}  // namespace

std::string discrepancyText(const discrepancy::DiscrepancyReport& report) {
  std::string text;
  for (const FirstScreenItem& item : firstScreen(report)) text += item.title + ": " + item.answer + "\n";
  text += "\n" + notTestable(report) + surfacesLine(report);
  for (const discrepancy::HeldOutGap& held : report.gap.foretold) text += foretoldLine(held);
  for (const std::string& missing : report.gap.missing) text += missing + "\n";
  for (const discrepancy::RepeatStep& step : report.steps) text += "Step: " + step.sentence + "\n";
  for (const std::string& limitation : report.limitations) text += "Limitation: " + limitation + "\n";
  return text + opened(report.inputs);
}

simulation::ValueRemarks fitRemarks(const discrepancy::DiscrepancyReport& report) {
  simulation::ValueRemarks remarks;
  for (const discrepancy::FoundEffect& effect : report.effects) {
    for (const discrepancy::FittedParameter& parameter : effect.parameters) {
      const bool known = std::isfinite(parameter.interval.low);
      remarks[effect.id + "." + parameter.name] =
          known ? "fitted, 95 % interval " + interval(parameter) : "fitted";
    }
  }
  return remarks;
}

std::string confirmationText(const discrepancy::Confirmation& confirmation) {
  std::string text =
      std::string(confirmation.passed ? "Confirmed" : "Not confirmed") + ": " + confirmation.sentence;
  text += "\nSize relative to the prediction: " + fixedText(confirmation.size, 2) + " (" +
          fixedText(confirmation.interval.low, 2) + " to " + fixedText(confirmation.interval.high, 2) +
          " by these bags alone); predicted for these bags: " + fixedText(confirmation.predicted.low, 2) +
          " to " + fixedText(confirmation.predicted.high, 2) + ", width " +
          fixedText(confirmation.predicted.high - confirmation.predicted.low, 2) +
          ". Without any fitting, the prediction explains " + percentText(confirmation.share_of_error, 0) +
          " of the squared error.\n";
  for (const discrepancy::RivalAnswer& rival : confirmation.rivals)
    text += "Rival " + rival.explanation + ": " + fixedText(rival.nats, 1) +
            " nats against the prediction; " + (rival.better ? "better beyond chance" : "not better") + ".\n";
  if (!confirmation.best_rival.empty()) text += "A rival explains more: " + confirmation.best_rival + ".\n";
  return text;
}

std::string confirmationYaml(const discrepancy::Confirmation& confirmation,
                             const std::string& prediction_hash,
                             const std::vector<discrepancy::InputUse>& inputs) {
  Json rivals = Json::array(), bags = Json::array();
  for (const discrepancy::RivalAnswer& rival : confirmation.rivals)
    rivals.push_back({{"explanation", rival.explanation}, {"nats", rival.nats}, {"better", rival.better}});
  for (const discrepancy::InputUse& input : inputs)
    bags.push_back({{"file", input.file}, {"sha256", input.sha256}});
  const Json members = {
      {"passed", confirmation.passed},
      {"size", confirmation.size},
      {"size_interval", Json::array({confirmation.interval.low, confirmation.interval.high})},
      {"predicted", Json::array({confirmation.predicted.low, confirmation.predicted.high})},
      {"p", confirmation.p},
      {"rivals", rivals},
      {"share_of_error", confirmation.share_of_error},
      {"best_rival", orElse(confirmation.best_rival, nullptr)},
      {"prediction_hash", prediction_hash},
      {"inputs", bags}};
  return "# " + confirmation.sentence + "\n" + yamlText(members, kDigits);
}

namespace {

// A number, or nothing if there is no value: spreadsheets read this as an empty cell.
std::string cell(double value) {
  return std::isfinite(value) ? settings::numberText(value) : "";
}

double at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : NAN;
}

std::string curveTable(const discrepancy::ResidualCurve& curve) {
  std::string text = "\"" + curve.covariate + (curve.unit.empty() ? "" : " [" + curve.unit + "]") +
                     "\",before [% FS],after [% FS],standard error [% FS]\n";
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    text += cell(curve.at[i]);
    for (const auto* values : {&curve.before, &curve.after, &curve.error}) {
      text += "," + cell(100 * at(*values, i));
    }
    text += '\n';
  }
  return text;
}

std::string gapRow(const std::string& name, double value, const discrepancy::Interval& interval,
                   double pressure) {
  return name + "," + cell(100 * value) + "," + cell(100 * interval.low) + "," + cell(100 * interval.high) +
         "," + cell(pressure) + "\n";
}

std::string gapTable(const discrepancy::Gap& gap) {
  return "gap,rms [% FS],low [% FS],high [% FS],rms [Pa]\n" +
         gapRow("before", gap.before, gap.before_interval, gap.before_pressure) +
         gapRow("after", gap.after, gap.after_interval, gap.after_pressure) +
         gapRow("floor", gap.floor, gap.floor_interval, gap.floor_pressure);
}

std::string candidatesTable(const std::vector<discrepancy::CandidateScore>& candidates) {
  std::string text = "explanation,outcome,nats,p,z,share of ceiling [%],at the map [Pa]\n";
  for (const discrepancy::CandidateScore& candidate : candidates) {
    std::string ids;
    for (const std::string& id : candidate.ids) ids += (ids.empty() ? "" : " + ") + id;
    text += ids + "," + candidate.outcome + "," + cell(candidate.nats) + "," + cell(candidate.p) + "," +
            cell(candidate.z) + "," + cell(100 * candidate.share_of_explainable) + "," +
            cell(candidate.at_map) + "\n";
  }
  return text;
}

}  // namespace

std::map<std::string, std::string> discrepancyTables(const discrepancy::DiscrepancyReport& report) {
  std::map<std::string, std::string> tables = {{"gap.csv", gapTable(report.gap)},
                                               {"candidates.csv", candidatesTable(report.candidates)}};
  for (const discrepancy::ResidualCurve& curve : report.curves)
    tables["residual_" + curve.covariate + ".csv"] = curveTable(curve);
  return tables;
}

}  // namespace fsr::report
