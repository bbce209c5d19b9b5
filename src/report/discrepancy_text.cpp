#include <cmath>
#include <map>

#include "report/discrepancy_report.h"
#include "report/flow_yaml.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

constexpr double kKilopascal = 1e3;  // [Pa]
constexpr double kPercent = 100;

std::string number(double value, int digits) {
  return std::isfinite(value) ? settings::fixedText(value, digits) : "-";
}

std::string joined(const std::vector<std::string>& items, const std::string& between = ", ") {
  std::string all;
  for (const std::string& item : items) all += (all.empty() ? "" : between) + item;
  return all;
}

// "3.10 % FS (19.2 kPa)".
std::string gapPart(double value, double pressure) {
  return number(kPercent * value, 2) + " % FS" +
         (std::isfinite(pressure) ? " (" + number(pressure / kKilopascal, 1) + " kPa)" : "");
}

std::string gapLine(const discrepancy::Gap& gap) {
  if (!std::isfinite(gap.before)) return "Gap: not measured.\n";
  std::string text = "Gap, rms on hold-out data: " + gapPart(gap.before, gap.before_pressure) + " before, " +
                     gapPart(gap.after, gap.after_pressure) + " after, floor " +
                     gapPart(gap.floor, gap.floor_pressure) + " (neighbouring scans; between cycles " +
                     gapPart(gap.floor_bracket.high, NAN) + ")";
  if (std::isfinite(gap.closed)) {
    text += "; closed " + number(kPercent * gap.closed, 0) + " %";
    if (std::isfinite(gap.closed_interval.low)) {
      text += " (" + number(kPercent * gap.closed_interval.low, 0) + " to " +
              number(kPercent * gap.closed_interval.high, 0) + " %)";
    }
  }
  return text + ".\n" + (gap.held_out_by.empty() ? "" : "Held out by: " + joined(gap.held_out_by) + ".\n");
}

// "Common trace explained on each condition with sizes fitted to the others: 93 % (flat 95 %, bent 90 %)."
std::string foretoldLine(const discrepancy::HeldOutGap& held) {
  std::vector<std::string> parts;
  for (const auto& [part, closed] : held.parts)
    parts.push_back(part + " " + number(kPercent * closed, 0) + " %");
  return "Common trace explained on each " + held.by +
         " with sizes fitted to the others: " + number(kPercent * held.closed, 0) + " % (" + joined(parts) +
         ").\n";
}

// "On each surface: flat 0.95 % FS before, 0.20 % FS after; ..."
std::string surfacesLine(const std::vector<discrepancy::SurfaceGap>& surfaces) {
  std::vector<std::string> parts;
  for (const discrepancy::SurfaceGap& one : surfaces)
    parts.push_back(one.surface + " " + gapPart(one.before, NAN) + " before, " + gapPart(one.after, NAN) +
                    " after");
  return parts.size() < 2 ? "" : "On each surface: " + joined(parts, "; ") + ".\n";
}

std::string useLine(const std::vector<discrepancy::GapInUse>& costs) {
  static const std::map<std::string, std::string> kSituations = {
      {"ramp", "a ramp"}, {"stance", "a stance of 0.6 s"}, {"standing", "ten minutes of standing"}};
  std::vector<std::string> parts;
  for (const discrepancy::GapInUse& cost : costs) {
    const auto found = kSituations.find(cost.situation);
    parts.push_back(
        number(cost.before / kKilopascal, 1) + " kPa in " +
        (found == kSituations.end() ? cost.situation : found->second) +
        (std::isfinite(cost.after) ? " (" + number(cost.after / kKilopascal, 1) + " with it)" : ""));
  }
  return parts.empty() ? "" : "Largest error if it is left out: " + joined(parts) + ".\n";
}

std::string notExcluded(const discrepancy::DiscrepancyReport& report) {
  std::vector<std::string> sets;
  for (const auto& ids : report.credible_set) sets.push_back(joined(ids, " + "));
  return sets.empty() ? "" : "Not excluded: " + joined(sets, " | ") + ".\n";
}

std::string notTestable(const discrepancy::DiscrepancyReport& report) {
  std::vector<std::string> effects;
  for (const discrepancy::NotIdentifiable& effect : report.not_identifiable) {
    const bool has_one = !effect.experiment.empty() && effect.experiment != "none";
    effects.push_back(effect.id + (has_one ? " (" + effect.experiment + ")" : ""));
  }
  return effects.empty() ? "" : "Not testable here (what would show it): " + joined(effects) + ".\n";
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
  return flow_yaml::number(parameter.interval.low) + " to " + flow_yaml::number(parameter.interval.high) +
         unit;
}

}  // namespace

std::string discrepancyText(const discrepancy::DiscrepancyReport& report) {
  std::string text = report.sentence + "\n" + notExcluded(report) + notTestable(report) +
                     gapLine(report.gap) + surfacesLine(report.gap.surfaces);
  if (!report.recompute.empty()) text += "Recompute the gap: " + report.recompute + "\n";
  for (const discrepancy::HeldOutGap& held : report.gap.foretold) text += foretoldLine(held);
  text += useLine(report.in_use);
  for (const std::string& missing : report.gap.missing) text += missing + "\n";
  for (const discrepancy::RepeatStep& step : report.steps) text += "Step: " + step.sentence + "\n";
  if (!report.next_experiment.empty())
    text += "Next experiment: " + report.next_experiment.front().sentence + "\n";
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
  text += "\nSize relative to the prediction: " + number(confirmation.size, 2) + " (" +
          number(confirmation.interval.low, 2) + " to " + number(confirmation.interval.high, 2) +
          "). Without any fitting, the prediction explains " +
          number(kPercent * confirmation.share_of_error, 0) + " % of the squared error.\n";
  if (!confirmation.best_rival.empty()) text += "A rival explains more: " + confirmation.best_rival + ".\n";
  return text;
}

std::string confirmationYaml(const discrepancy::Confirmation& confirmation,
                             const std::string& prediction_hash,
                             const std::vector<discrepancy::InputUse>& inputs) {
  namespace yaml = flow_yaml;
  std::string text = "# " + confirmation.sentence + "\npassed: " + (confirmation.passed ? "true" : "false") +
                     "\nsize: " + yaml::number(confirmation.size) +
                     "\nsize_interval: " + yaml::pair(confirmation.interval.low, confirmation.interval.high) +
                     "\nshare_of_error: " + yaml::number(confirmation.share_of_error) + "\nbest_rival: " +
                     (confirmation.best_rival.empty() ? "null" : yaml::text(confirmation.best_rival)) +
                     "\nprediction_hash: \"" + prediction_hash + "\"\ninputs:\n";
  for (const discrepancy::InputUse& input : inputs) {
    text +=
        "  - " + yaml::map({{"file", yaml::text(input.file)}, {"sha256", "\"" + input.sha256 + "\""}}) + "\n";
  }
  return text;
}

}  // namespace fsr::report
