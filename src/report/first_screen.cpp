#include <algorithm>
#include <cmath>
#include <map>

#include "report/discrepancy_report.h"
#include "report/text_table.h"
#include "settings/number_text.h"
#include "settings/text.h"

namespace fsr::report {

namespace {

using discrepancy::DiscrepancyReport;
using discrepancy::Verdict;

constexpr double kPercent = 100;

// "1.3 kPa", of two digits.
std::string pressureText(double pressure) {
  return settings::roundedPressure(pressure, 2);
}

std::string roundedPercent(double share, int digits = 2) {
  return settings::roundedText(kPercent * share, digits) + " %";
}

std::string setsText(const std::vector<std::vector<std::string>>& sets) {
  std::vector<std::string> texts;
  for (const auto& ids : sets) texts.push_back(settings::joined(ids, " + "));
  return settings::joined(texts, " | ");
}

bool nothingFound(const DiscrepancyReport& report) {
  return report.verdict == Verdict::kNone || report.verdict == Verdict::kNotIdentifiable;
}

std::string chanceText(const DiscrepancyReport& report) {
  if (std::isnan(report.p)) return "Nothing was compared.";
  return "The probability of the best score by chance is " + settings::roundedText(report.p, 2) +
         " (corrected for the search; level " + settings::roundedText(report.options.level, 2) + ").";
}

// Whether explanations of the mean trace competed and one of them is in the verdict.
bool byCompetition(const DiscrepancyReport& report) {
  return report.p <= report.options.level && !std::isnan(report.at_map) && report.too_small.empty();
}

std::string sureText(const DiscrepancyReport& report) {
  const std::string credible = roundedPercent(report.options.credible);
  const std::string best =
      "Best of these " + std::to_string(report.tested.size()) + " effects, under this protocol";
  switch (report.verdict) {
    case Verdict::kNone:
    case Verdict::kNotIdentifiable:
      return !(report.p <= report.options.level)
                 ? chanceText(report)
                 : chanceText(report) + " What is visible is too small to matter.";
    case Verdict::kUnknown:
      return (byCompetition(report) ? chanceText(report) + " " : "") + "No name is given.";
    case Verdict::kNamed:
    case Verdict::kWrongForm:
    case Verdict::kAmbiguous:
      break;
  }
  std::string text = "Not excluded: " + setsText(report.credible_set) + ". " + best;
  if (!byCompetition(report)) return text + "; found by a test of its own.";
  const bool alone = report.credible_set.size() == 1;
  return text + (alone ? "; all others are excluded at " : "; the others are excluded at ") + credible +
         ". " + chanceText(report);
}

// "Would have been seen, from this size at the map: 0.7 kPa: creep, drift; 1.2 kPa: wear."
std::string seenText(const DiscrepancyReport& report) {
  std::map<double, std::vector<std::string>> seen;
  for (const discrepancy::SmallestSeen& one : report.smallest_seen) {
    if (std::isfinite(one.at_map)) seen[one.at_map].push_back(one.id);
  }
  std::vector<std::string> texts;
  for (const auto& [size, ids] : seen) texts.push_back(pressureText(size) + ": " + settings::joined(ids));
  std::string text =
      texts.empty()
          ? ""
          : "Would have been seen, from this size at the map: " + settings::joined(texts, "; ") + ".";
  for (const discrepancy::TooSmall& one : report.too_small) {
    text += (text.empty() ? "" : " ") + one.explanation + " is visible, but with " +
            pressureText(one.at_map) + " it is below the least gap of " + pressureText(one.least_gap) + ".";
  }
  return text;
}

std::string answersText(const DiscrepancyReport& report) {
  std::vector<std::string> texts;
  for (const discrepancy::Answer& answer : report.answers) {
    std::string text = answer.id + ": " + answer.answer + ". " + answer.sentence;
    if (std::isfinite(answer.at_map))
      text += " From " + pressureText(answer.at_map) + " at the map it would have been seen.";
    texts.push_back(text);
  }
  return settings::joined(texts, " ");
}

std::string situationText(const std::string& situation) {
  if (situation == "ramp") return "a ramp";
  if (situation == "stance") return "a stance of 0.6 s";
  return situation == "standing" ? "ten minutes of standing" : situation;
}

std::string useText(const std::vector<discrepancy::GapInUse>& costs) {
  std::vector<std::string> parts;
  for (const discrepancy::GapInUse& cost : costs) {
    parts.push_back(
        settings::fixedPressure(cost.before, 1) + " in " + situationText(cost.situation) +
        (std::isfinite(cost.after) ? " (" + settings::inShownUnit(cost.after) + " with it)" : ""));
  }
  return parts.empty() ? "" : " Largest error in use: " + settings::joined(parts) + ".";
}

std::string costText(const DiscrepancyReport& report) {
  if (nothingFound(report)) return "";
  if (std::isnan(report.at_map))
    return useText(report.in_use).empty() ? "" : useText(report.in_use).substr(1);
  return pressureText(report.at_map) + " at the map (rms) if it is left out; the least gap is " +
         pressureText(report.least_gap) + "." + useText(report.in_use);
}

std::string scatterText(const discrepancy::Scatter& one) {
  const std::string what = one.part == "cycle_gain"     ? "The gain changes from cycle to cycle"
                           : one.part == "cycle_offset" ? "The zero changes from cycle to cycle"
                                                        : "The reading wanders within a cycle";
  const std::string unit = one.unit == "share" ? "" : " of full scale";
  if (!one.seen()) return what + " by less than " + roundedPercent(one.interval.high) + unit + ".";
  return what + " by " + roundedPercent(one.size) + unit + " (standard deviation, 95 % " +
         settings::roundedText(kPercent * one.interval.low, 2) + " to " + roundedPercent(one.interval.high) +
         "): " + pressureText(one.at_map) + " at the map, " + roundedPercent(one.of_noise) +
         " of the variance of the noise.";
}

// The largest first.
std::string scattersText(const DiscrepancyReport& report) {
  std::vector<discrepancy::Scatter> sorted = report.scatter;
  const auto size = [](const discrepancy::Scatter& one) { return one.at_map > 0 ? one.at_map : 0; };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const auto& a, const auto& b) { return size(a) > size(b); });
  std::vector<std::string> texts;
  for (const discrepancy::Scatter& one : sorted) texts.push_back(scatterText(one));
  return settings::joined(texts, " ");
}

// Whether the cycles scatter by more than what is missing.
bool scattersMore(const DiscrepancyReport& report) {
  const auto& all = report.scatter;
  return !nothingFound(report) && std::any_of(all.begin(), all.end(), [&](const discrepancy::Scatter& one) {
    return one.seen() && one.at_map > report.at_map;
  });
}

// "3.10 % FS (19.2 kPa)".
std::string gapPart(double value, double pressure) {
  return settings::percentText(value, 2) + " FS" +
         (std::isfinite(pressure) ? " (" + settings::fixedPressure(pressure, 1) + ")" : "");
}

std::string gapText(const DiscrepancyReport& report) {
  const discrepancy::Gap& gap = report.gap;
  if (!std::isfinite(gap.before)) return "Not measured, because nothing was held out.";
  const bool added = !report.effects.empty();
  // Readings and pressures weigh the same errors differently, so one may fall while the other rises.
  const bool apart = added && (gap.after - gap.before) * (gap.after_pressure - gap.before_pressure) < 0;
  const auto part = [&](double value, double pressure) { return gapPart(value, apart ? NAN : pressure); };
  std::string text = part(gap.before, gap.before_pressure) + " before, ";
  text += added ? part(gap.after, gap.after_pressure) + " after, " : "nothing was added, ";
  text += "floor " + part(gap.floor, gap.floor_pressure) + " (neighbouring scans; between cycles " +
          gapPart(gap.floor_bracket.high, NAN) + ")";
  if (std::isfinite(gap.closed)) {
    text += "; closed " + settings::percentText(gap.closed, 0);
    if (std::isfinite(gap.closed_interval.low)) {
      text += " (" + settings::fixedText(kPercent * gap.closed_interval.low, 0) + " to " +
              settings::percentText(gap.closed_interval.high, 0) + ")";
    }
  }
  text += ".";
  if (added && gap.after > gap.before) text += " The gap did not shrink.";
  if (apart)
    text += std::string(" As a pressure it ") +
            (gap.after_pressure > gap.before_pressure ? "rises" : "falls") + ", from " +
            settings::inShownUnit(gap.before_pressure) + " to " +
            settings::fixedPressure(gap.after_pressure, 1) +
            ": there, errors count more where the curves are flat.";
  return text + (gap.held_out_by.empty() ? "" : " Held out by: " + settings::joined(gap.held_out_by) + ".");
}

// Experiments that would show the effects of the credible set that these recordings cannot show.
std::vector<std::string> needed(const DiscrepancyReport& report) {
  std::vector<std::string> texts;
  for (const discrepancy::NotIdentifiable& one : report.not_identifiable) {
    const auto names_it = [&](const auto& ids) { return std::count(ids.begin(), ids.end(), one.id) > 0; };
    const auto& sets = report.credible_set;
    if (std::none_of(sets.begin(), sets.end(), names_it)) continue;
    if (!one.experiment.empty() && one.experiment != "none")
      texts.push_back(one.id + " needs the experiment " + one.experiment);
  }
  return texts;
}

std::string nextText(const DiscrepancyReport& report) {
  std::vector<std::string> sentences;
  for (const discrepancy::NextExperiment& next : report.next_experiment) sentences.push_back(next.sentence);
  if (!sentences.empty()) return settings::joined(sentences, " ");
  if (!std::isfinite(report.gap.before))
    return "Record at least 10 cycles on each surface, so that some can be held out.";
  const std::vector<std::string> needs = needed(report);
  if (!needs.empty()) return settings::joined(needs) + ".";
  switch (report.verdict) {
    case Verdict::kNone:
    case Verdict::kNotIdentifiable:
      return "Nothing has to be told apart. The effects that are not testable here name their experiment.";
    case Verdict::kNamed:
    case Verdict::kWrongForm:
      return report.prediction.effects.empty()
                 ? "Nothing has to be told apart."
                 : "Nothing has to be told apart. New bags of at least 10 cycles, under another protocol, "
                   "can confirm it: discrepancy --confirm verdict.yaml NEWBAG.";
    case Verdict::kAmbiguous:
      return "No experiment that this rig can run tells the explanations apart.";
    case Verdict::kUnknown:
      return "No experiment is known that would lead to a name.";
  }
  return "";
}

}  // namespace

std::vector<FirstScreenItem> firstScreen(const DiscrepancyReport& report) {
  const bool first = scattersMore(report);
  const std::string scatter = scattersText(report);
  const std::vector<FirstScreenItem> all = {{"Scatter, more than what is missing", first ? scatter : ""},
                                            {"Missing", report.sentence},
                                            {"How sure", sureText(report)},
                                            {"Excluded", nothingFound(report) ? seenText(report) : ""},
                                            {"Asked", answersText(report)},
                                            {"Cost", costText(report)},
                                            {"Gain for the map", report.map_gain},
                                            {"Scatter", first ? "" : scatter},
                                            {"Gap, rms on hold-out data", gapText(report)},
                                            {"Recompute the gap", report.recompute},
                                            {"Next experiment", nextText(report)}};
  std::vector<FirstScreenItem> items;
  for (const FirstScreenItem& item : all) {
    if (!item.answer.empty()) items.push_back(item);
  }
  return items;
}

}  // namespace fsr::report
