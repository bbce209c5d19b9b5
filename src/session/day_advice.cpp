#include <algorithm>
#include <map>
#include <utility>

#include "session/day_report.h"

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

std::string listText(const Sentences& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

Advice notDone(const DayReport& day) {
  Advice advice{"Steps of the plan that were not done", "the state of the session", {}};
  for (const DayMount& mount : day.mounts) {
    const auto open = std::count_if(mount.steps.begin(), mount.steps.end(),
                                    [](const DayStep& step) { return step.fate != StepFate::kAccepted; });
    const std::string where = "Mount " + std::to_string(mount.number) + " on " + mount.surface + ": ";
    if (open > 0 && static_cast<std::size_t>(open) == mount.steps.size()) {
      advice.sentences.push_back(where + "none of its " + std::to_string(open) + " steps was done.");
      continue;
    }
    for (const DayStep& step : mount.steps) {
      if (step.fate == StepFate::kAccepted) continue;
      advice.sentences.push_back(
          where + step.text +
          (step.fate == StepFate::kSkipped ? " It was skipped." : " It was not reached."));
    }
  }
  return advice;
}

Advice warnedOf(const Json& training) {
  return {"What train warns of", "train, warnings", training.at("warnings").get<Sentences>()};
}

Advice thinCoverage(const Json& training) {
  Advice advice{"Pressures and surfaces with few scans or none", "train, coverage", {}};
  for (const Json& sentence : training.at("coverage").at("thin"))
    advice.sentences.push_back(sentence.get<std::string>());
  return advice;
}

Advice notAssessed(const Json& training) {
  Advice advice{"Parts of the error that are not assessed", "train, error budget", {}};
  const Json& budget = training.at("error_budget");
  if (budget.is_null()) return advice;
  Sentences never;
  std::vector<Json> lines = budget.at("lines");
  // A map is used on a mount of its own, so this line comes first.
  std::stable_partition(lines.begin(), lines.end(),
                        [](const Json& line) { return line.at("name") == "mount"; });
  for (const Json& line : lines) {
    if (line.at("source") != "not assessed") continue;
    const auto name = line.at("name").get<std::string>(), note = line.at("note").get<std::string>();
    const auto what = whatAssesses().find(name);
    if (what == whatAssesses().end()) {
      never.push_back(name + " (" + note + ")");
    } else {
      advice.sentences.push_back(what->second + " The line \"" + name + "\" is not assessed: " + note + ".");
    }
  }
  if (!never.empty())
    advice.sentences.push_back("No recording of this sheet in the chamber assesses: " + listText(never) +
                               ".");
  return advice;
}

Advice missedByTraining(const Json& training) {
  Advice advice{"What training missed", "train", {}};
  for (const std::string& choice : choicesOfTraining(training)) {
    if (choice.find("; record ") != std::string::npos) advice.sentences.push_back(choice);
  }
  return advice;
}

// Effects with one reason and one experiment share a sentence.
Advice notTold(const Json& discrepancy) {
  Advice advice{"Effects that discrepancy cannot tell from these bags", "discrepancy", {}};
  std::vector<std::pair<std::pair<std::string, std::string>, Sentences>> groups;
  for (const Json& effect : discrepancy.at("not_identifiable")) {
    const std::pair key{effect.at("experiment").get<std::string>(), effect.at("reason").get<std::string>()};
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const auto& one) { return one.first == key; });
    if (group == groups.end()) group = groups.insert(group, {key, {}});
    group->second.push_back(effect.at("id").get<std::string>());
  }
  for (const Json& item : discrepancy.at("first_screen")) {
    if (item.at("title") == "Next experiment")
      advice.sentences.push_back("Next experiment: " + item.at("answer").get<std::string>());
  }
  for (const auto& [key, effects] : groups)
    advice.sentences.push_back(listText(effects) + ": " + key.second +
                               " An experiment that shows it: " + key.first + ".");
  for (const Json& missing : discrepancy.at("gap").at("missing"))
    advice.sentences.push_back(missing.get<std::string>());
  return advice;
}

void addRefusal(const std::string& tool, const DayPart& part, std::vector<Advice>& all) {
  if (!part.refused.empty()) all.push_back({"What " + tool + " asks for", tool, {part.refused}});
}

}  // namespace

std::vector<std::string> choicesOfTraining(const Json& training) {
  std::vector<std::string> choices;
  for (const char* const part : {"history", "session", "temperature"}) {
    const Json& found = training.at(part);
    if (found.is_object() && found.contains("choice"))
      choices.push_back(found.at("choice").get<std::string>());
  }
  return choices;
}

std::vector<Advice> whatToRecordNext(const DayReport& day) {
  std::vector<Advice> all;
  addRefusal("check_bag", day.check, all);
  addRefusal("train", day.training, all);
  if (day.training.result.is_object()) all.push_back(warnedOf(day.training.result));
  all.push_back(notDone(day));
  if (day.training.result.is_object()) {
    all.push_back(thinCoverage(day.training.result));
    all.push_back(notAssessed(day.training.result));
    all.push_back(missedByTraining(day.training.result));
  }
  addRefusal("discrepancy", day.discrepancy, all);
  if (day.discrepancy.result.is_object()) all.push_back(notTold(day.discrepancy.result));
  all.push_back({"What the plan leaves open, also where all of it is done", "plan_session", day.plan_limits});
  all.erase(std::remove_if(all.begin(), all.end(), [](const Advice& one) { return one.sentences.empty(); }),
            all.end());
  return all;
}

}  // namespace fsr::session
