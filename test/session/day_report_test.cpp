#include "session/day_report.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "session/html_page.h"

namespace {

using namespace fsr::session;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Json scoreJson(double rmse) {
  return {{"surface", "flat"},
          {"readings", 100},
          {"r2", {{"mean", 0.98765}, {"deviation", 0.00123}}},
          {"rmse_percent", {{"mean", 3.4567}, {"deviation", 0.1234}}},
          {"within_one_deviation", 0.6789},
          {"errors_pa",
           {{"whole",
             {{"all",
               {{"rmse", rmse},
                {"bias", -111.4},
                {"limits_95", {-34416, 34639}},
                {"p95_absolute", nullptr}}}}}}}};
}

Json lineJson(const std::string& name, const std::string& source, const Json& values,
              const std::string& note) {
  return {{"name", name},          {"source", source},      {"part", "inside"},
          {"standard_pa", values}, {"added_pa", {0, 0, 0}}, {"note", note}};
}

// What train writes, with numbers of its own.
Json trainingJson() {
  const Json other = {{"readings", 0},
                      {"rmse", nullptr},
                      {"rmse_percent_mean", nullptr},
                      {"rmse_percent_deviation", nullptr}};
  const Json none = {nullptr, nullptr, nullptr};
  return {{"id", "df7d93648987"},
          {"scheme", "interpolated"},
          {"model", {{"name", "grnn"}}},
          {"provenance",
           {{"date", "2026-11-23T18:45:14Z"},
            {"tool_version", "0.2.0"},
            {"conditioning", {"conditioning: marked by an event"}}}},
          {"warnings", Json::array()},
          {"coverage", {{"thin", {"flat, 400+ kPa unloading: no scans"}}}},
          {"scores",
           {{"conditions", {scoreJson(17616.76)}},
            {"whole", scoreJson(17177.2)},
            {"unseen_curvature", other},
            {"another_mount", other}}},
          {"history",
           {{"choice", "History: none, since all cycles have one protocol; record cycles with two paces."}}},
          {"session", nullptr},
          {"temperature", {{"choice", "Temperature: none."}}},
          {"error_budget",
           {{"share_of_range", {0.1, 0.5, 0.9}},
            {"pressure_pa", {50000, 250000, 450000}},
            {"lines",
             {lineJson("resolution", "measured here", {51, 80, 119}, "one count"),
              lineJson("mount", "not assessed", none, "no surface was mounted more than once"),
              lineJson("in a socket", "not assessed", none, "shear, compliance, humidity")}},
            {"held_out_pa", {16730, 25630, 12930}},
            {"combined_pa", {16730, 25634, nullptr}}}}};
}

Json discrepancyJson() {
  const auto effect = [](const char* id) {
    return Json{{"id", id}, {"experiment", "remount"}, {"reason", "No surface was mounted twice."}};
  };
  return {
      {"sentence", "Nothing is missing."},
      {"first_screen",
       {{{"title", "Missing"}, {"answer", "Nothing."}}, {{"title", "Next experiment"}, {"answer", "None."}}}},
      {"not_identifiable", {effect("repositioning"), effect("break_in")}},
      {"gap",
       {{"missing", Json::array()},
        {"surfaces", {{{"surface", "flat"}, {"before", 0.0199}, {"after", 0.0037}}}}}},
      {"limitations", Json::array()}};
}

DayStep step(const std::string& text, StepFate fate) {
  DayStep one;
  one.text = text;
  one.fate = fate;
  return one;
}

DayReport fullDay() {
  DayReport day;
  day.plan = "day";
  day.headline = "day (per_curvature): 20 min, 1 mount on 1 surface, one bag each";
  day.folder = "/rig/day";
  day.rejected = 1;
  DayMount mount;
  mount.surface = "flat";
  mount.bags = {"day_01_flat.bag"};
  mount.steps = {step("Put the sheet on flat, mount 1.", StepFate::kAccepted),
                 step("Cycle 1 of 2.", StepFate::kAccepted), step("Cycle 2 of 2.", StepFate::kSkipped)};
  mount.steps[1].rejected = 1;
  mount.steps[1].remarks = {"rejected (peak_missed): the highest pressure was 400 kPa"};
  day.mounts = {mount};
  day.coverage = "<svg></svg>";
  day.calibration = "day_calibration.h5";
  day.check = {"rosrun fsr_pressure_map check_bag day_01_flat.bag", "", "bag\nFit for training.\n", nullptr};
  day.training = {"rosrun fsr_pressure_map train day_01_flat.bag", "", "table\n", trainingJson()};
  day.discrepancy = {"rosrun fsr_pressure_map discrepancy day_01_flat.bag", "", "answer\n",
                     discrepancyJson()};
  return day;
}

std::vector<std::string> adviceOf(const DayReport& day, const std::string& source) {
  for (const Advice& advice : whatToRecordNext(day)) {
    if (advice.source == source) return advice.sentences;
  }
  return {};
}

TEST(HtmlPage, EscapesWhatANameMayContain) {
  EXPECT_EQ(escaped("<script>\"a\" & 'b'</script>\x01\n"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;?\n");
}

TEST(HtmlPage, EscapesTitlesCellsItemsAndCaptions) {
  const std::string bad = "<b>&";
  HtmlPage page(bad);
  page.heading(bad), page.smallHeading(bad), page.paragraph(bad), page.box({bad}), page.refusal(bad);
  page.list({bad}), page.table(bad, {bad}, {{bad}}), page.lines(bad), page.figure("<svg></svg>", bad);
  page.fold(bad), page.endFold();
  EXPECT_FALSE(has(page.text(), bad)) << page.text();
  EXPECT_TRUE(has(page.text(), "<td>&lt;b&gt;&amp;</td>")) << page.text();
}

TEST(HtmlPage, AlignsNumbersToTheRight) {
  HtmlPage page("");
  page.table("", {}, {{"12.5", "-", "-3.1 to 4.2", "95 % limits", "flat"}});
  EXPECT_TRUE(has(page.text(),
                  "<tr><td class=\"number\">12.5</td><td class=\"number\">-</td><td>-3.1 to 4.2</td><td>95 % "
                  "limits</td><td>flat</td></tr>"))
      << page.text();
}

TEST(DayPage, ShowsTheFiguresOfTheTools) {
  const std::string page = dayHtml(fullDay());
  for (const char* const part :
       {"held-out error 17.2 kPa (rms)", "k = 2 in the middle of the range 51.27 kPa",  // summary
        "<td class=\"number\">0.9877 ± 0.0012</td><td class=\"number\">3.46 ± 0.12</td><td "
        "class=\"number\">17.6</td>",
        "<td>-34.4 to 34.6</td><td class=\"number\">-</td><td class=\"number\">67.9</td>",
        "<td>resolution</td><td class=\"number\">0.05</td><td class=\"number\">0.08</td><td "
        "class=\"number\">0.12</td>",
        "<td>combined, k = 2</td><td class=\"number\">33.46</td><td class=\"number\">51.27</td><td "
        "class=\"number\">-</td>",
        "<td>flat</td><td class=\"number\">1.99</td><td class=\"number\">0.37</td>",
        "2 of 3 steps accepted, 1 skipped", "1 attempt rejected",
        "rejected (peak_missed): the highest pressure was 400 kPa", "Bags: Fit for training.",
        "conditioning: marked by an event"}) {
    EXPECT_TRUE(has(page, part)) << part << "\n" << page;
  }
}

TEST(DayPage, TheFirstLineIsWhatTheMapIsGoodFor) {
  DayReport day = fullDay();
  day.training.result["good_for"] = "On a new mount of a known surface: 68 % within 6 kPa.";
  EXPECT_TRUE(
      has(dayHtml(day), "<div class=\"box\">\n<p>On a new mount of a known surface: 68 % within 6 kPa.</p>"))
      << dayHtml(day);
}

// Behind a mistake that is made again and again, one that was made once is not to be overlooked.
TEST(DayPage, EqualRejectionsAreOneRowWithTheirNumber) {
  DayReport day = fullDay();
  auto& steps = day.mounts[0].steps;
  steps[1].remarks.clear();
  for (int kpa = 300; kpa < 313; ++kpa)
    steps[1 + kpa % 2].remarks.push_back("rejected (sheet_off): no taxel answers " + std::to_string(kpa) +
                                         " kPa");
  steps[2].remarks.push_back("rejected (leak): leak");
  const std::string page = dayHtml(day);
  EXPECT_TRUE(has(page,
                  "<td class=\"number\">13</td><td>Cycle 1 of 2.</td><td>rejected (sheet_off): no taxel "
                  "answers 300 kPa</td></tr>"))
      << page;
  EXPECT_TRUE(
      has(page, "<td class=\"number\">1</td><td>Cycle 2 of 2.</td><td>rejected (leak): leak</td></tr>"))
      << page;
  EXPECT_FALSE(has(page, "301 kPa"));
}

std::string advicesOf(const std::string& page) {
  const std::size_t begin = page.find("<ul>", page.find("What to record next"));
  return page.substr(begin, page.find("</ul>", begin) - begin);
}

TEST(DayPage, GivesFiveAdvicesAtMostAndWhatMattersMostFirst) {
  DayReport day = fullDay();
  day.plan_limits = {"The plan has one pace."};
  day.training.result["warnings"] = {"mount 5 differs"};
  for (int cell = 0; cell < 30; ++cell)
    day.training.result["coverage"]["thin"].push_back("cell " + std::to_string(cell));
  const std::string page = dayHtml(day), advices = advicesOf(page);
  std::size_t items = 0;
  for (std::size_t at = advices.find("<li>"); at != std::string::npos; at = advices.find("<li>", at + 1))
    ++items;
  EXPECT_EQ(items, 5u) << advices;
  EXPECT_EQ(advices.find("<ul>\n<li>What train warns of: mount 5 differs</li>"), 0u) << advices;
  EXPECT_TRUE(has(advices, "few scans or none: flat, 400+ kPa unloading: no scans (30 more below)</li>"))
      << advices;
  EXPECT_TRUE(has(page, "<li>cell 29</li>"));
  day.training = {"train", "too few cycles", "", nullptr};
  EXPECT_EQ(advicesOf(dayHtml(day)).find("<ul>\n<li>What train asks for: too few cycles</li>"), 0u);
}

TEST(DayPage, NeedsNoNetwork) {
  const std::string page = dayHtml(fullDay());
  for (const char* const part : {"http", "src=", "href", "<link", "<script", "<iframe", "url(", "@import"})
    EXPECT_FALSE(has(page, part)) << part;
}

TEST(DayPage, APartThatIsRefusedAppearsWithItsSentence) {
  DayReport day = fullDay();
  day.training = {"train", "train: day_01_flat.bag has 1 surface <1>", "", nullptr};
  day.discrepancy = {"discrepancy", "too few cycles", "", nullptr};
  const std::string page = dayHtml(day);
  EXPECT_TRUE(has(page, "train gave no result: train: day_01_flat.bag has 1 surface &lt;1&gt;")) << page;
  EXPECT_TRUE(has(page, "discrepancy gave no result: too few cycles"));
  EXPECT_FALSE(has(page, "kPa (rms)"));
  EXPECT_EQ(adviceOf(day, "discrepancy"), std::vector<std::string>{"too few cycles"});
}

TEST(DayPage, AResultOfAnotherFormIsNamedAndBreaksNothing) {
  DayReport day = fullDay();
  day.training.result = Json{{"id", "df7d93648987"}};
  const std::string page = dayHtml(day);
  EXPECT_TRUE(has(page, "What train wrote is incomplete")) << page;
  EXPECT_TRUE(has(page, "Every step"));
}

TEST(DayPage, ACalibrationWithoutScoresHasNoFigures) {
  DayReport day = fullDay();
  day.training.result["scores"] = day.training.result["error_budget"] = nullptr;
  const std::string page = dayHtml(day);
  EXPECT_TRUE(has(page, "train computed no scores."));
  EXPECT_TRUE(has(page, "train computed no error budget."));
  EXPECT_FALSE(has(page, "kPa (rms)"));
}

TEST(DayAdvice, NamesWhatWasNotDone) {
  DayReport day = fullDay();
  EXPECT_EQ(adviceOf(day, "the state of the session"),
            std::vector<std::string>{"Mount 1 on flat: Cycle 2 of 2. It was skipped."});
  for (DayStep& one : day.mounts[0].steps) one.fate = StepFate::kOpen;
  EXPECT_EQ(adviceOf(day, "the state of the session"),
            std::vector<std::string>{"Mount 1 on flat: none of its 3 steps was done."});
}

TEST(DayAdvice, SaysWhatWouldAssessALineOfTheBudget) {
  EXPECT_EQ(
      adviceOf(fullDay(), "train, error budget"),
      (std::vector<std::string>{
          "Put the sheet on each surface two times or more. The line \"mount\" is not assessed: no surface "
          "was "
          "mounted more than once.",
          "No recording of this sheet in the chamber assesses: in a socket (shear, compliance, humidity)."}));
}

TEST(DayAdvice, CarriesTheSentencesOfTheTools) {
  EXPECT_EQ(adviceOf(fullDay(), "train, coverage"),
            std::vector<std::string>{"flat, 400+ kPa unloading: no scans"});
  EXPECT_EQ(adviceOf(fullDay(), "train"),
            std::vector<std::string>{
                "History: none, since all cycles have one protocol; record cycles with two paces."});
  EXPECT_EQ(
      adviceOf(fullDay(), "discrepancy"),
      (std::vector<std::string>{
          "Next experiment: None.",
          "repositioning, break_in: No surface was mounted twice. An experiment that shows it: remount."}));
}

TEST(DayAdvice, IsEmptyWhereNothingIsMissing) {
  DayReport day = fullDay();
  day.mounts[0].steps.pop_back();
  day.training.result["coverage"]["thin"] = Json::array();
  day.training.result["error_budget"]["lines"] = Json::array();
  day.training.result["history"] = nullptr;
  day.discrepancy.result["not_identifiable"] = day.discrepancy.result["first_screen"] = Json::array();
  EXPECT_TRUE(whatToRecordNext(day).empty());
  EXPECT_TRUE(has(dayHtml(day), "no part asks for more"));
}

}  // namespace
