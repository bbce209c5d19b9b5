#include <iomanip>
#include <sstream>

#include "report/flow_yaml.h"
#include "report/verdict_file.h"

namespace fsr::report {

namespace {

namespace yaml = flow_yaml;

std::string parameterText(const discrepancy::FittedParameter& parameter) {
  return yaml::map({{"name", yaml::text(parameter.name)},
                    {"value", yaml::number(parameter.value)},
                    {"unit", parameter.unit.empty() ? "null" : yaml::text(parameter.unit)},
                    {"interval", yaml::pair(parameter.interval.low, parameter.interval.high)}});
}

std::string effectText(const discrepancy::FoundEffect& effect) {
  std::vector<std::string> parameters;
  for (const discrepancy::FittedParameter& parameter : effect.parameters)
    parameters.push_back(parameterText(parameter));
  return "  - id: " + yaml::text(effect.id) + "\n    parameters: " + yaml::list(parameters) +
         "\n    evidence: " +
         yaml::map({{"z", yaml::number(effect.z)},
                    {"share_of_ceiling", yaml::number(effect.share_of_explainable)}}) +
         "\n";
}

std::string effectsText(const std::vector<discrepancy::FoundEffect>& effects) {
  if (effects.empty()) return "effects: []\n";
  std::string text = "effects:\n";
  for (const discrepancy::FoundEffect& effect : effects) text += effectText(effect);
  return text;
}

std::string credibleText(const std::vector<std::vector<std::string>>& sets) {
  std::vector<std::string> items;
  for (const auto& ids : sets) items.push_back(yaml::texts(ids));
  return "credible_set: " + yaml::list(items) + "\n";
}

std::string notIdentifiableText(const std::vector<discrepancy::NotIdentifiable>& effects) {
  std::vector<std::string> items;
  for (const discrepancy::NotIdentifiable& effect : effects) {
    const std::string experiment = effect.experiment.empty() ? "null" : yaml::text(effect.experiment);
    items.push_back(yaml::map({{"id", yaml::text(effect.id)}, {"experiment", experiment}}));
  }
  return "not_identifiable: " + yaml::list(items) + "\n";
}

std::string whereText(const discrepancy::WhereItShows& where) {
  std::vector<std::string> taxels, times;
  for (const std::size_t taxel : where.taxels) taxels.push_back(std::to_string(taxel));
  for (const auto& [from, to] : where.times) times.push_back(yaml::pair(from, to));
  const auto orAll = [](const std::vector<std::string>& items) {
    return items.empty() ? "all" : yaml::list(items);
  };
  return "where: " +
         yaml::map({{"taxels", orAll(taxels)},
                    {"conditions", where.conditions.empty() ? "all" : yaml::texts(where.conditions)},
                    {"pressure", yaml::pair(where.pressure.low, where.pressure.high)},
                    {"direction", yaml::text(where.direction)},
                    {"time", orAll(times)}}) +
         "\n";
}

std::string coveredText(const std::vector<discrepancy::CoveredPressures>& covered) {
  std::vector<std::string> items;
  for (const discrepancy::CoveredPressures& one : covered)
    items.push_back(yaml::map({{"surface", yaml::text(one.surface)},
                               {"pressure", yaml::pair(one.pressure.low, one.pressure.high)}}));
  return yaml::list(items);
}

std::string surfacesText(const std::vector<discrepancy::SurfaceGap>& surfaces) {
  std::vector<std::string> items;
  for (const discrepancy::SurfaceGap& one : surfaces)
    items.push_back(yaml::map({{"surface", yaml::text(one.surface)},
                               {"before", yaml::number(one.before)},
                               {"after", yaml::number(one.after)}}));
  return yaml::list(items);
}

std::string gapText(const discrepancy::Gap& gap) {
  return "gap: " +
         yaml::map({{"before", yaml::number(gap.before)},
                    {"after", yaml::number(gap.after)},
                    {"floor", yaml::number(gap.floor)},
                    {"floor_bracket", yaml::pair(gap.floor_bracket.low, gap.floor_bracket.high)},
                    {"closed", yaml::number(gap.closed)},
                    {"closed_interval", yaml::pair(gap.closed_interval.low, gap.closed_interval.high)},
                    {"unit", "fraction of full scale"},
                    {"held_out_by", yaml::texts(gap.held_out_by)},
                    {"surfaces", surfacesText(gap.surfaces)},
                    {"covered", coveredText(gap.covered)},
                    {"left_out", std::to_string(gap.left_out)}}) +
         "\n";
}

// A stamp in seconds, every nanosecond kept.
std::string stampText(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecond = 1000000000;  // [ns]
  std::ostringstream text;
  text << stamp_ns / kSecond << "." << std::setw(9) << std::setfill('0') << stamp_ns % kSecond;
  return text.str();
}

std::string holdOutText(const std::vector<discrepancy::HoldOutCycles>& bags) {
  if (bags.empty()) return "hold_out: []\n";
  std::string text = "hold_out:\n";
  for (const discrepancy::HoldOutCycles& bag : bags) {
    std::vector<std::string> cycles;
    for (const auto& [first, last] : bag.cycles)
      cycles.push_back(yaml::list({stampText(first), stampText(last)}));
    text += "  - " + yaml::map({{"file", yaml::text(bag.file)}, {"cycles", yaml::list(cycles)}}) + "\n";
  }
  return text;
}

std::string experimentText(const discrepancy::NextExperiment& next, const std::string& then) {
  return yaml::map({{"protocol", yaml::text(next.protocol)},
                    {"sentence", yaml::text(next.sentence)},
                    {"separation", yaml::number(next.separation)},
                    {"cycles", std::to_string(next.cycles)},
                    {"certainty", yaml::number(next.certainty)},
                    {"entropy", yaml::pair(next.entropy_before, next.entropy)},
                    {"then", then}});
}

// A second experiment stands in the first one, as what follows it.
std::string nextText(const std::vector<discrepancy::NextExperiment>& next) {
  std::string text = "null";
  for (auto one = next.rbegin(); one != next.rend(); ++one) text = experimentText(*one, text);
  return "next_experiment: " + text + "\n";
}

std::string predictionText(const discrepancy::Prediction& prediction) {
  if (prediction.effects.empty()) return "prediction: null\n";
  std::vector<std::string> weights;
  for (const double weight : prediction.weights) weights.push_back(yaml::number(weight));
  return "prediction: " +
         yaml::map({{"size", yaml::pair(prediction.size.low, prediction.size.high)},
                    {"weights", yaml::list(weights)}}) +
         "\n";
}

std::string seenText(const std::vector<discrepancy::SmallestSeen>& seen) {
  std::vector<std::string> items;
  for (const discrepancy::SmallestSeen& one : seen)
    items.push_back(yaml::map({{"id", yaml::text(one.id)}, {"at_map", yaml::number(one.at_map)}}));
  return "smallest_seen: " + yaml::list(items) + "\n";
}

std::string tooSmallText(const std::vector<discrepancy::TooSmall>& small) {
  std::vector<std::string> items;
  for (const discrepancy::TooSmall& one : small)
    items.push_back(yaml::map({{"explanation", yaml::text(one.explanation)},
                               {"p", yaml::number(one.p)},
                               {"at_map", yaml::number(one.at_map)}}));
  return "too_small: " + yaml::list(items) + "\n";
}

std::string scatterText(const std::vector<discrepancy::Scatter>& scatter) {
  std::vector<std::string> items;
  for (const discrepancy::Scatter& one : scatter)
    items.push_back(yaml::map({{"part", yaml::text(one.part)},
                               {"size", yaml::number(one.size)},
                               {"unit", yaml::text(one.unit)},
                               {"interval", yaml::pair(one.interval.low, one.interval.high)},
                               {"at_map", yaml::number(one.at_map)}}));
  return "scatter: " + yaml::list(items) + "\n";
}

std::string answersText(const std::vector<discrepancy::Answer>& answers) {
  std::vector<std::string> items;
  for (const discrepancy::Answer& one : answers)
    items.push_back(yaml::map({{"id", yaml::text(one.id)}, {"answer", yaml::text(one.answer)}}));
  return "asked: " + yaml::list(items) + "\n";
}

std::string inUseText(const std::vector<discrepancy::GapInUse>& costs) {
  std::vector<std::string> items;
  for (const discrepancy::GapInUse& one : costs)
    items.push_back(yaml::map({{"situation", yaml::text(one.situation)},
                               {"before", yaml::number(one.before)},
                               {"after", yaml::number(one.after)}}));
  return "in_use: " + yaml::list(items) + "\n";
}

// How sure the verdict is and what it costs. Sizes are in Pa.
std::string evidenceText(const discrepancy::DiscrepancyReport& report) {
  return "p: " + yaml::number(report.p) + "\nat_map: " + yaml::number(report.at_map) +
         "\nleast_gap: " + yaml::number(report.least_gap) + "\n" + inUseText(report.in_use) +
         seenText(report.smallest_seen) + tooSmallText(report.too_small) + scatterText(report.scatter) +
         answersText(report.answers);
}

std::string inputsText(const std::vector<discrepancy::InputUse>& inputs) {
  std::string text = "inputs:\n";
  for (const discrepancy::InputUse& input : inputs) {
    text += "  - " +
            yaml::map({{"file", yaml::text(input.file)},
                       {"sha256", "\"" + input.sha256 + "\""},
                       {"show_opened", std::to_string(input.hold_out_opened)}}) +
            "\n";
  }
  return text;
}

}  // namespace

std::string verdictText(const discrepancy::DiscrepancyReport& report) {
  const bool shows = report.verdict != discrepancy::Verdict::kNone &&
                     report.verdict != discrepancy::Verdict::kNotIdentifiable;
  return "# " + report.sentence + "\nverdict: " + discrepancy::name(report.verdict) + "\n" +
         effectsText(report.effects) + credibleText(report.credible_set) +
         "depends_on: " + yaml::texts(report.depends_on) + "\n" + evidenceText(report) +
         notIdentifiableText(report.not_identifiable) + (shows ? whereText(report.where) : "where: null\n") +
         gapText(report.gap) + holdOutText(report.hold_out) +
         "recompute: " + (report.recompute.empty() ? "null" : yaml::text(report.recompute)) + "\n" +
         nextText(report.next_experiment) + predictionText(report.prediction) +
         "seed: " + std::to_string(report.seed) + "\nversion: " + yaml::text(report.version) + "\n" +
         inputsText(report.inputs);
}

}  // namespace fsr::report
