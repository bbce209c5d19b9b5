#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <filesystem>

#include "session/coverage.h"
#include "session/day_report.h"
#include "session/html_page.h"
#include "session/plan.h"
#include "session/session_files.h"
#include "settings/number_text.h"
#include "settings/text.h"

namespace fsr::session {

namespace {

using Row = std::vector<std::string>;

std::string kilopascals(const Json& pressure, int decimals, double factor = 1) {
  return pressure.is_null() ? "-" : settings::fixedText(factor * pressure.get<double>() / 1e3, decimals);
}

std::string lastLine(std::string text) {
  boost::trim_right_if(text, boost::is_any_of("\n"));
  return text.substr(text.rfind('\n') + 1);
}

std::string attempts(std::size_t number) {
  return std::to_string(number) + (number == 1 ? " attempt" : " attempts") + " rejected";
}

bool rejects(const StepRemark& remark) {
  return remark.reason != Reason::kNone;
}

/// How many steps became what.
struct StepCount {
  std::size_t planned = 0, accepted = 0, skipped = 0, open = 0, rejected = 0;
};

template <typename Wanted>
StepCount count(const DayReport& day, Wanted wanted) {
  StepCount counted;
  for (std::size_t s = 0; s < day.steps.size(); ++s) {
    if (!wanted(day.steps[s])) continue;
    ++counted.planned;
    counted.accepted += day.state.steps[s] == StepState::kAccepted;
    counted.skipped += day.state.steps[s] == StepState::kSkipped;
    counted.open += day.state.steps[s] == StepState::kOpen;
  }
  for (const StepRemark& remark : day.state.remarks)
    counted.rejected += rejects(remark) && wanted(day.steps[remark.step]);
  return counted;
}

// ---- sections ----------------------------------------------------------------------------------------

std::string calibrationSentence(const DayPart& training) {
  if (!training.refused.empty()) return "Calibration: none. " + training.refused;
  const Json &scores = training.result.at("scores"), &budget = training.result.at("error_budget");
  std::string sentence = "Calibration: " + training.result.at("id").get<std::string>();
  if (!scores.is_null())
    sentence += ", held-out error " +
                kilopascals(scores.at("whole").at("errors_pa").at("whole").at("all").at("rmse"), 1) +
                " kPa (rms)";
  if (!budget.is_null())
    sentence += ", uncertainty with k = 2 in the middle of the range " +
                kilopascals(budget.at("combined_pa").at(1), 2, 2) + " kPa";
  return sentence + ".";
}

void summary(HtmlPage& page, const DayReport& day) {
  const StepCount all = count(day, [](const SessionStep&) { return true; });
  std::vector<std::string> sentences;
  const bool trained = day.training.result.is_object();
  const std::string good_for = trained ? day.training.result.value("good_for", "") : "";
  if (!good_for.empty()) sentences.push_back(good_for);
  sentences.push_back("Plan: " + std::to_string(all.accepted) + " of " + std::to_string(all.planned) +
                      " steps accepted, " + std::to_string(all.skipped) + " skipped, " +
                      std::to_string(all.open) + " not reached; " + attempts(day.state.rejected) + ".");
  sentences.push_back("Bags: " +
                      (day.check.refused.empty() ? lastLine(day.check.printed) : day.check.refused));
  try {
    sentences.push_back(calibrationSentence(day.training));
    sentences.push_back("Sheet against simulation: " +
                        (day.discrepancy.refused.empty()
                             ? day.discrepancy.result.at("sentence").get<std::string>()
                             : "no answer. " + day.discrepancy.refused));
  } catch (const Json::exception& error) {
    page.refusal(std::string("What a tool wrote is incomplete: ") + error.what());
  }
  page.element("p", headline(day.plan) + ". Folder: " + day.folder);
  page.box(sentences);
}

void recorded(HtmlPage& page, const DayReport& day) {
  page.element("h2", "What was recorded");
  std::vector<Row> rows;
  for (const SessionStep& mount : day.steps) {
    if (mount.kind != StepKind::kMount) continue;
    const std::vector<std::string> bags = bagsOf(day, mount.mount);
    const StepCount counted = count(day, [&](const SessionStep& step) { return step.mount == mount.mount; });
    rows.push_back({std::to_string(mount.mount), mount.surface, std::to_string(counted.accepted),
                    std::to_string(counted.skipped), std::to_string(counted.open),
                    std::to_string(counted.rejected), bags.empty() ? "none" : settings::joined(bags)});
  }
  page.table(
      "Steps of each mount: number accepted, skipped, not reached; attempts rejected. Source: state of the "
      "session.",
      {"mount", "surface", "accepted", "skipped", "not reached", "rejected", "bags"}, rows);
  for (const std::string& sentence : day.closed_now) page.element("p", sentence + ".");
  for (const std::string& sentence : day.not_closed) page.refusal("Not in this report: " + sentence);
  const StepCount conditioning =
      count(day, [](const SessionStep& step) { return step.kind == StepKind::kCondition; });
  page.element("p", conditioning.planned == 0
                        ? "Conditioning: the plan has none."
                        : "Conditioning: " + std::to_string(conditioning.accepted) + " of " +
                              std::to_string(conditioning.planned) + " cycles accepted.");
  if (day.training.result.is_object() && day.training.result.contains("provenance")) {
    for (const Json& sentence : day.training.result["provenance"].value("conditioning", Json::array()))
      page.element("p", "The bags say: " + sentence.get<std::string>() + ".");
  }
  page.figure(coverageSvg(coverageOf(day.plan, day.steps, day.state.steps)),
              "Coverage: passes of each surface through each tenth of the pressure, while loading and "
              "unloading; below, steps of each pace and dwell. Filled: accepted share of the planned ones; "
              "yellow: complete.");
}

// Those of one mount with one reason are one row.
void remarks(HtmlPage& page, const DayReport& day) {
  struct Group {
    unsigned mount, times;
    const StepRemark* first;
  };
  std::vector<Group> groups;
  for (const StepRemark& remark : day.state.remarks) {
    const unsigned mount = day.steps[remark.step].mount;
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& one) {
      return one.mount == mount && one.first->reason == remark.reason &&
             (rejects(remark) || one.first->sentence == remark.sentence);
    });
    if (same != groups.end())
      ++same->times;
    else
      groups.push_back({mount, 1, &remark});
  }
  if (groups.empty()) return;
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) { return a.mount < b.mount; });
  std::vector<Row> rows;
  for (const Group& one : groups) {
    const SessionStep& step = day.steps[one.first->step];
    rows.push_back({std::to_string(one.mount), step.surface, std::to_string(one.times), instruction(step),
                    (rejects(*one.first) ? "rejected (" + name(one.first->reason) + "): " : std::string()) +
                        one.first->sentence});
  }
  page.table(
      "Attempts that were rejected, and those accepted by hand. Where there are several on one mount "
      "for one reason, step and sentence are those of the first.",
      {"mount", "surface", "times", "step", "what was said"}, rows);
}

void printedBy(HtmlPage& page, const std::string& tool, const DayPart& part, const std::string& heading) {
  page.element("h2", heading);
  if (!part.refused.empty()) page.refusal(tool + " gave no result: " + part.refused);
  if (!part.printed.empty()) page.element("pre", part.printed);
}

void next(HtmlPage& page, const DayReport& day) {
  page.element("h2", "What to record next");
  std::vector<Advice> all;
  try {
    all = whatToRecordNext(day);
  } catch (const Json::exception& error) {
    return page.refusal(std::string("What the tools wrote is incomplete: ") + error.what());
  }
  if (all.empty()) return page.element("p", "The plan is done, and no part asks for more.");
  constexpr std::size_t kMostAdvices = 5;  // more are not done
  std::vector<std::string> first;
  std::size_t sentences = 0;
  for (const Advice& advice : all) {
    sentences += advice.sentences.size();
    const std::size_t more = advice.sentences.size() - 1;
    if (first.size() < kMostAdvices)
      first.push_back(advice.title + ": " + advice.sentences.front() +
                      (more > 0 ? " (" + std::to_string(more) + " more below)" : ""));
  }
  page.list(first);
  if (sentences == first.size()) return;
  page.fold("All " + std::to_string(sentences) + " remarks on what could be recorded");
  for (const Advice& advice : all) {
    page.element("h3", advice.title);
    page.list(advice.sentences);
    page.element("p", "Source: " + advice.source + ".");
  }
  page.endFold();
}

void everyStep(HtmlPage& page, const DayReport& day) {
  page.element("h2", "Every step");
  std::vector<Row> rows;
  for (std::size_t s = 0; s < day.steps.size(); ++s) {
    const SessionStep& step = day.steps[s];
    const StepState state = day.state.steps[s];
    const auto rejected = static_cast<std::size_t>(
        std::count_if(day.state.remarks.begin(), day.state.remarks.end(),
                      [s](const StepRemark& remark) { return remark.step == s && rejects(remark); }));
    rows.push_back({std::to_string(s + 1), std::to_string(step.mount), step.surface, instruction(step),
                    std::string(state == StepState::kAccepted  ? "accepted"
                                : state == StepState::kSkipped ? "skipped"
                                                               : "not reached") +
                        (rejected == 0 ? "" : ", " + attempts(rejected))});
  }
  page.table("The plan, and what became of it.", {"step", "mount", "surface", "instruction", "state"}, rows);
}

}  // namespace

DayReport dayOf(const SessionPlan& plan, const ConductorState& state, const std::string& folder) {
  static_cast<void>(Conductor(plan, state));  // refuses the state of another plan
  DayReport day;
  day.plan = plan;
  day.steps = sessionSteps(plan);
  day.state = state;
  day.folder = std::filesystem::absolute(folder).lexically_normal().string();
  day.calibration = sessionFile(plan.name, kCalibrationFile);
  return day;
}

std::vector<std::string> bagsOf(const DayReport& day, unsigned mount) {
  std::vector<std::string> bags;
  for (const SessionStep& step : day.steps) {
    if (step.kind != StepKind::kMount || (mount > 0 && step.mount != mount)) continue;
    for (const std::string& bag : bagsOfMount(day.folder, bagStem(day.plan.name, step.mount, step.surface)))
      bags.push_back(bag);
  }
  return bags;
}

std::string dayHtml(const DayReport& day) {
  HtmlPage page("Report of the day: " + day.plan.name);
  summary(page, day);
  recorded(page, day);
  remarks(page, day);
  printedBy(page, "check_bag", day.check, "Whether the bags are fit");
  printedBy(page, "train", day.training, "How good the calibration is");
  printedBy(page, "discrepancy", day.discrepancy, "What the sheet does that the simulation lacks");
  next(page, day);
  everyStep(page, day);
  page.element("h2", "How to compute it again");
  page.element("p", "In the folder of the session. The last line writes this page anew.");
  page.element("pre", day.check.command + "\n" + day.training.command + "\n" + day.discrepancy.command +
                          "\nrosrun fsr_pressure_map day_report .");
  return page.text();
}

}  // namespace fsr::session
