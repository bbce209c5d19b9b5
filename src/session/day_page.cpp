#include <algorithm>
#include <functional>
#include <limits>
#include <sstream>

#include "session/day_report.h"
#include "session/html_page.h"
#include "settings/number_text.h"

namespace fsr::session {

namespace {

using settings::cellText;
using Row = std::vector<std::string>;

// [Pa], NaN where it is null.
double number(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

std::string kilopascals(const Json& pressure, int decimals) {
  return cellText(number(pressure) / 1e3, decimals);
}

std::string spread(const Json& score, const char* name, int decimals) {
  return cellText(number(score.at(name).at("mean")), decimals) + " ± " +
         cellText(number(score.at(name).at("deviation")), decimals);
}

std::string lastLine(const std::string& text) {
  std::istringstream lines(text);
  std::string line, last;
  while (std::getline(lines, line)) {
    if (!line.empty()) last = line;
  }
  return last;
}

std::string attempts(unsigned number) {
  return std::to_string(number) + (number == 1 ? " attempt" : " attempts") + " rejected";
}

struct StepCount {
  std::size_t accepted = 0, skipped = 0, open = 0;
  unsigned rejected = 0;
};

StepCount& operator+=(StepCount& sum, const StepCount& more) {
  sum.accepted += more.accepted;
  sum.skipped += more.skipped;
  sum.open += more.open;
  sum.rejected += more.rejected;
  return sum;
}

StepCount count(const DayMount& mount) {
  StepCount counted;
  for (const DayStep& step : mount.steps) {
    counted.accepted += step.fate == StepFate::kAccepted;
    counted.skipped += step.fate == StepFate::kSkipped;
    counted.open += step.fate == StepFate::kOpen;
    counted.rejected += step.rejected;
  }
  return counted;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// A result whose form is not the expected one is refused like a tool that failed.
void part(HtmlPage& page, const std::string& tool, const DayPart& part,
          const std::function<void(const Json&)>& write) {
  if (!part.refused.empty()) return page.refusal(tool + " gave no result: " + part.refused);
  try {
    write(part.result);
  } catch (const Json::exception& error) {
    page.refusal("What " + tool + " wrote is incomplete: " + error.what());
  }
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
                cellText(2 * number(budget.at("combined_pa").at(1)) / 1e3, 2) + " kPa";
  return sentence + ".";
}

std::string discrepancySentence(const DayPart& discrepancy) {
  if (!discrepancy.refused.empty()) return "Sheet against simulation: no answer. " + discrepancy.refused;
  return "Sheet against simulation: " + discrepancy.result.at("sentence").get<std::string>();
}

void summary(HtmlPage& page, const DayReport& day) {
  StepCount all;
  for (const DayMount& mount : day.mounts) all += count(mount);
  std::vector<std::string> sentences;
  const bool trained = day.training.result.is_object();
  const std::string good_for = trained ? day.training.result.value("good_for", "") : "";
  if (!good_for.empty()) sentences.push_back(good_for);
  sentences.push_back("Plan: " + std::to_string(all.accepted) + " of " +
                      std::to_string(all.accepted + all.skipped + all.open) + " steps accepted, " +
                      std::to_string(all.skipped) + " skipped, " + std::to_string(all.open) +
                      " not reached; " + attempts(day.rejected) + ".");
  ;
  sentences.push_back("Bags: " +
                      (day.check.refused.empty() ? lastLine(day.check.printed) : day.check.refused));
  try {
    sentences.push_back(calibrationSentence(day.training));
    sentences.push_back(discrepancySentence(day.discrepancy));
  } catch (const Json::exception&) {
    // The section says what is incomplete.
  }
  page.paragraph(day.headline + ". Folder: " + day.folder);
  page.box(sentences);
}

// Of the conditioning, by the plan.
std::string conditioningSentence(const DayReport& day) {
  std::size_t planned = 0, accepted = 0;
  for (const DayMount& mount : day.mounts) {
    for (const DayStep& step : mount.steps) {
      planned += step.conditioning;
      accepted += step.conditioning && step.fate == StepFate::kAccepted;
    }
  }
  if (planned == 0) return "Conditioning: the plan has none.";
  return "Conditioning: " + std::to_string(accepted) + " of " + std::to_string(planned) + " cycles accepted.";
}

void recorded(HtmlPage& page, const DayReport& day) {
  page.heading("What was recorded");
  std::vector<Row> rows;
  for (const DayMount& mount : day.mounts) {
    const StepCount counted = count(mount);
    rows.push_back({std::to_string(mount.number), mount.surface, std::to_string(counted.accepted),
                    std::to_string(counted.skipped), std::to_string(counted.open),
                    std::to_string(counted.rejected), mount.bags.empty() ? "none" : joined(mount.bags)});
  }
  page.table(
      "Steps of each mount: number accepted, skipped, not reached; attempts rejected. Source: state of the "
      "session.",
      {"mount", "surface", "accepted", "skipped", "not reached", "rejected", "bags"}, rows);
  for (const std::string& sentence : day.closed_now) page.paragraph(sentence + ".");
  for (const std::string& sentence : day.not_closed) page.refusal("Not in this report: " + sentence);
  page.paragraph(conditioningSentence(day));
  if (day.training.result.is_object() && day.training.result.contains("provenance")) {
    for (const Json& sentence : day.training.result["provenance"].value("conditioning", Json::array()))
      page.paragraph("The bags say: " + sentence.get<std::string>() + ".");
  }
  page.figure(day.coverage,
              "Coverage: passes of each surface through each tenth of the pressure, while loading and "
              "unloading; below, "
              "steps of each pace and dwell. Filled: accepted share of the planned ones; yellow: complete.");
  if (!day.check.refused.empty()) page.refusal("check_bag gave no result: " + day.check.refused);
}

// "rejected (leak)" of a rejection; else the whole remark.
std::string kindOf(const std::string& remark) {
  const bool rejected = remark.rfind("rejected (", 0) == 0;
  return rejected ? remark.substr(0, remark.find("): ")) : remark;
}

// Those of one mount with one reason are one row.
void remarks(HtmlPage& page, const DayReport& day) {
  struct Group {
    std::string kind;
    unsigned times;
    Row row;
  };
  std::vector<Row> rows;
  for (const DayMount& mount : day.mounts) {
    std::vector<Group> groups;
    for (const DayStep& step : mount.steps) {
      for (const std::string& remark : step.remarks) {
        const std::string kind = kindOf(remark);
        const auto same =
            std::find_if(groups.begin(), groups.end(), [&](const Group& one) { return one.kind == kind; });
        if (same != groups.end())
          ++same->times;
        else
          groups.push_back({kind, 1, {std::to_string(mount.number), mount.surface, step.text, remark}});
      }
    }
    for (Group& one : groups) {
      one.row.insert(one.row.begin() + 2, std::to_string(one.times));
      rows.push_back(one.row);
    }
  }
  if (rows.empty()) return;
  page.table(
      "Attempts that were rejected, and those accepted by hand. Where there are several on one mount "
      "for one reason, step and sentence are those of the first.",
      {"mount", "surface", "times", "step", "what was said"}, rows);
}

Row scoreRow(const std::string& surface, const Json& score) {
  const Json& errors = score.at("errors_pa").at("whole").at("all");
  return {
      surface,
      spread(score, "r2", 4),
      spread(score, "rmse_percent", 2),
      kilopascals(errors.at("rmse"), 1),
      kilopascals(errors.at("bias"), 1),
      kilopascals(errors.at("limits_95").at(0), 1) + " to " + kilopascals(errors.at("limits_95").at(1), 1),
      kilopascals(errors.at("p95_absolute"), 1),
      cellText(100 * number(score.at("within_one_deviation")), 1)};
}

std::string otherError(const Json& score, const std::string& what) {
  if (score.at("readings").get<double>() == 0) return what + ": not assessed.";
  return what + ": " + kilopascals(score.at("rmse"), 1) + " kPa (rms), " +
         cellText(number(score.at("rmse_percent_mean")), 2) + " ± " +
         cellText(number(score.at("rmse_percent_deviation")), 2) + " % over the taxels.";
}

void scoreTable(HtmlPage& page, const Json& scores) {
  std::vector<Row> rows;
  for (const Json& condition : scores.at("conditions"))
    rows.push_back(scoreRow(condition.at("surface").get<std::string>(), condition));
  rows.push_back(scoreRow("all together", scores.at("whole")));
  page.table(
      "Held-out readings, predicted without their section. R2 and RMSE%: mean ± standard deviation over the "
      "taxels; errors in kPa.",
      {"surface", "R2", "RMSE%", "RMSE", "bias", "95 % limits", "95 % of |error|", "% within 1 deviation"},
      rows);
  page.list({otherError(scores.at("unseen_curvature"), "Error between trained curvatures"),
             otherError(scores.at("another_mount"), "Error on another mount")});
}

void calibration(HtmlPage& page, const DayReport& day) {
  page.heading("How good the calibration is");
  part(page, "train", day.training, [&](const Json& training) {
    page.paragraph("File " + day.calibration + ", id " + training.at("id").get<std::string>() + ", scheme " +
                   training.at("scheme").get<std::string>() + ", model " +
                   training.at("model").at("name").get<std::string>() + ", trained " +
                   training.at("provenance").at("date").get<std::string>() + " with version " +
                   training.at("provenance").at("tool_version").get<std::string>() + ".");
    if (training.at("scores").is_null())
      page.refusal("train computed no scores.");
    else
      scoreTable(page, training.at("scores"));
    std::vector<std::string> choices;
    for (const Json& warning : training.at("warnings"))
      choices.push_back("Warning: " + warning.get<std::string>());
    for (const std::string& choice : choicesOfTraining(training)) choices.push_back(choice);
    page.list(choices);
  });
}

Row budgetRow(const std::string& name, const Json& values, double factor, const std::string& more) {
  Row row = {name};
  for (const Json& value : values) row.push_back(cellText(factor * number(value) / 1e3, 2));
  row.push_back(more);
  return row;
}

std::string wordsOf(const Json& line) {
  const auto source = line.at("source").get<std::string>(), note = line.at("note").get<std::string>();
  return source + (source == "not assessed" ? "" : ", " + line.at("part").get<std::string>()) + ": " + note;
}

void budget(HtmlPage& page, const DayReport& day) {
  page.heading("Error budget");
  part(page, "train", day.training, [&](const Json& training) {
    const Json& budget = training.at("error_budget");
    if (budget.is_null()) return page.refusal("train computed no error budget.");
    Row headings = {"at % of the trained range"};
    for (const Json& share : budget.at("share_of_range"))
      headings.push_back(cellText(100 * number(share), 0) + " %");
    headings.emplace_back("source");
    std::vector<Row> rows = {budgetRow("pressure", budget.at("pressure_pa"), 1, "")};
    for (const Json& line : budget.at("lines"))
      rows.push_back(budgetRow(line.at("name").get<std::string>(), line.at("standard_pa"), 1, wordsOf(line)));
    rows.push_back(budgetRow("held-out error", budget.at("held_out_pa"), 1, "root mean square"));
    for (const Json& line : budget.at("lines")) {
      const Json& added = line.at("added_pa");
      if (std::any_of(added.begin(), added.end(), [](const Json& more) { return number(more) > 0; }))
        rows.push_back(budgetRow("+ " + line.at("name").get<std::string>(), added, 1, ""));
    }
    rows.push_back(budgetRow("combined, k = 1", budget.at("combined_pa"), 1, ""));
    rows.push_back(budgetRow("combined, k = 2", budget.at("combined_pa"), 2, ""));
    page.table(
        "Standard uncertainties in kPa. Lines \"inside\" are parts of the held-out error and are not added "
        "again.",
        headings, rows);
  });
}

void gapTable(HtmlPage& page, const Json& gap) {
  std::vector<Row> rows;
  for (const Json& surface : gap.at("surfaces")) {
    rows.push_back({surface.at("surface").get<std::string>(), cellText(100 * number(surface.at("before")), 2),
                    cellText(100 * number(surface.at("after")), 2)});
  }
  if (rows.empty()) return;
  page.table("Gap on hold-out data: root mean square in % of full scale.",
             {"surface", "without the effect", "with it"}, rows);
}

void discrepancy(HtmlPage& page, const DayReport& day) {
  page.heading("What the sheet does that the simulation lacks");
  part(page, "discrepancy", day.discrepancy, [&](const Json& found) {
    std::vector<Row> rows;
    for (const Json& item : found.at("first_screen"))
      rows.push_back({item.at("title").get<std::string>(), item.at("answer").get<std::string>()});
    page.table("", {"question", "answer"}, rows);
    gapTable(page, found.at("gap"));
    std::vector<std::string> limitations;
    for (const Json& one : found.at("limitations"))
      limitations.push_back("Limitation: " + one.get<std::string>());
    if (!limitations.empty()) page.list(limitations);
  });
}

void next(HtmlPage& page, const DayReport& day) {
  page.heading("What to record next");
  std::vector<Advice> all;
  try {
    all = whatToRecordNext(day);
  } catch (const Json::exception& error) {
    return page.refusal(std::string("What the tools wrote is incomplete: ") + error.what());
  }
  if (all.empty()) return page.paragraph("The plan is done, and no part asks for more.");
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
    page.smallHeading(advice.title);
    page.list(advice.sentences);
    page.paragraph("Source: " + advice.source + ".");
  }
  page.endFold();
}

const char* fateName(StepFate fate) {
  return fate == StepFate::kAccepted ? "accepted" : fate == StepFate::kSkipped ? "skipped" : "not reached";
}

void everyStep(HtmlPage& page, const DayReport& day) {
  page.heading("Every step");
  std::vector<Row> rows;
  for (const DayMount& mount : day.mounts) {
    for (const DayStep& step : mount.steps) {
      const std::string fate = fateName(step.fate);
      const std::string again = step.rejected == 0 ? "" : ", " + attempts(step.rejected);
      rows.push_back({std::to_string(rows.size() + 1), std::to_string(mount.number), mount.surface, step.text,
                      fate + again});
    }
  }
  page.table("The plan, and what became of it.", {"step", "mount", "surface", "instruction", "state"}, rows);
}

void recompute(HtmlPage& page, const DayReport& day) {
  page.heading("How to compute it again");
  page.paragraph("In the folder of the session. The last line writes this page anew.");
  page.lines(day.check.command + "\n" + day.training.command + "\n" + day.discrepancy.command +
             "\nrosrun fsr_pressure_map day_report .");
  for (const auto& [tool, part] : {std::pair{"check_bag", &day.check}, std::pair{"train", &day.training},
                                   std::pair{"discrepancy", &day.discrepancy}}) {
    if (part->printed.empty()) continue;
    page.smallHeading(std::string("What ") + tool + " printed");
    page.lines(part->printed);
  }
}

}  // namespace

std::string dayHtml(const DayReport& day) {
  HtmlPage page("Report of the day: " + day.plan);
  summary(page, day);
  recorded(page, day);
  remarks(page, day);
  calibration(page, day);
  budget(page, day);
  discrepancy(page, day);
  next(page, day);
  everyStep(page, day);
  recompute(page, day);
  return page.text();
}

}  // namespace fsr::session
