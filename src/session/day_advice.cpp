#include <algorithm>
#include <map>
#include <utility>

#include "session/day_report.h"
#include "session/plan.h"
#include "settings/text.h"

namespace fsr::session {

namespace {

using Sentences = std::vector<std::string>;

// What would assess a line of the error budget, by the line's name. Only recordings and statements of a
// session stand here. What a chamber with one sheet cannot assess has no entry.
const std::map<std::string, std::string>& whatAssesses() {
  static const std::map<std::string, std::string> what = {
      {"transducer of the chamber",
       "State the uncertainty of the transducer: day_report or train with --transducer."},
      {"holding a load", "Record cycles with a dwell, and a hold."},
      {"mount", "Put the sheet on each surface two times or more."},
      {"temperature of the sheet", "Record with a thermometer, at temperatures that differ."},
      {"curvature of the surface", "State the deviation of the curvature in the surface files."},
      {"between trained curvatures", "Record a surface whose curvature is between two others."},
      {"with the history model",
       "Record cycles with two paces, with short and long dwells, and partial loops."},
      {"age of the sheet", "Record some cycles again in the next weeks, and recheck the calibration."}};
  return what;
}

// A mount of which nothing was done is one sentence.
Sentences notDone(const DayReport& day) {
  Sentences sentences;
  const std::vector<SessionStep>& steps = day.steps;
  for (std::size_t first = 0, end = 0; first < steps.size(); first = end) {
    std::size_t open = 0;
    for (end = first; end < steps.size() && steps[end].mount == steps[first].mount; ++end)
      open += day.state.steps[end] != StepState::kAccepted;
    const std::string where =
        "Mount " + std::to_string(steps[first].mount) + " on " + steps[first].surface + ": ";
    if (open == end - first) {
      sentences.push_back(where + "none of its " + std::to_string(open) + " steps was done.");
      continue;
    }
    for (std::size_t s = first; s < end; ++s) {
      if (day.state.steps[s] == StepState::kAccepted) continue;
      const bool skipped = day.state.steps[s] == StepState::kSkipped;
      sentences.push_back(where + instruction(steps[s]) +
                          (skipped ? " It was skipped." : " It was not reached."));
    }
  }
  return sentences;
}

Sentences notAssessed(const Json& training) {
  Sentences sentences, never;
  const Json& budget = training.at("error_budget");
  if (budget.is_null()) return {};
  std::vector<Json> lines = budget.at("lines");
  // A map is used on a mount of its own, so this line comes first.
  std::stable_partition(lines.begin(), lines.end(),
                        [](const Json& line) { return line.at("name") == "mount"; });
  for (const Json& line : lines) {
    if (line.at("source") != "not assessed") continue;
    const auto name = line.at("name").get<std::string>(), note = line.at("note").get<std::string>();
    const auto what = whatAssesses().find(name);
    if (what == whatAssesses().end())
      never.push_back(name + " (" + note + ")");
    else
      sentences.push_back(what->second + " The line \"" + name + "\" is not assessed: " + note + ".");
  }
  if (!never.empty())
    sentences.push_back("No recording of this sheet in the chamber assesses: " + settings::joined(never) +
                        ".");
  return sentences;
}

// What training says about the sheet's memory, a tare at the start of a session and the temperature.
Sentences missedByTraining(const Json& training) {
  Sentences sentences;
  for (const char* const part : {"history", "session", "temperature"}) {
    const Json& found = training.at(part);
    const std::string choice = found.is_object() ? found.value("choice", "") : "";
    if (choice.find("; record ") != std::string::npos) sentences.push_back(choice);
  }
  return sentences;
}

// Effects with one reason and one experiment share a sentence.
Sentences notTold(const Json& discrepancy) {
  Sentences sentences;
  for (const Json& item : discrepancy.at("first_screen")) {
    if (item.at("title") == "Next experiment")
      sentences.push_back("Next experiment: " + item.at("answer").get<std::string>());
  }
  std::vector<std::pair<std::string, Sentences>> groups;
  for (const Json& effect : discrepancy.at("not_identifiable")) {
    const std::string why = effect.at("reason").get<std::string>() +
                            " An experiment that shows it: " + effect.at("experiment").get<std::string>();
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const auto& one) { return one.first == why; });
    if (group == groups.end()) group = groups.insert(group, {why, {}});
    group->second.push_back(effect.at("id").get<std::string>());
  }
  for (const auto& [why, effects] : groups) sentences.push_back(settings::joined(effects) + ": " + why + ".");
  for (const Json& missing : discrepancy.at("gap").at("missing"))
    sentences.push_back(missing.get<std::string>());
  return sentences;
}

}  // namespace

std::vector<Advice> whatToRecordNext(const DayReport& day) {
  std::vector<Advice> all;
  const auto add = [&all](const std::string& title, const std::string& source, const Sentences& sentences) {
    if (!sentences.empty()) all.push_back({title, source, sentences});
  };
  const auto addRefusal = [&](const std::string& tool, const DayPart& part) {
    if (!part.refused.empty()) add("What " + tool + " asks for", tool, {part.refused});
  };
  const Json &training = day.training.result, &discrepancy = day.discrepancy.result;
  addRefusal("check_bag", day.check);
  addRefusal("train", day.training);
  if (training.is_object()) add("What train warns of", "train, warnings", training.at("warnings"));
  add("Steps of the plan that were not done", "the state of the session", notDone(day));
  if (training.is_object()) {
    add("Pressures and surfaces with few scans or none", "train, coverage",
        training.at("coverage").at("thin"));
    add("Parts of the error that are not assessed", "train, error budget", notAssessed(training));
    add("What training missed", "train", missedByTraining(training));
  }
  addRefusal("discrepancy", day.discrepancy);
  if (discrepancy.is_object())
    add("Effects that discrepancy cannot tell from these bags", "discrepancy", notTold(discrepancy));
  add("What the plan leaves open, also where all of it is done", "plan_session", limitsOf(day.plan));
  return all;
}

}  // namespace fsr::session
