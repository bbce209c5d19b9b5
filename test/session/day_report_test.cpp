#include "session/day_report.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "session/example_plans.h"
#include "session/html_page.h"
#include "support/holds.h"

namespace {

using namespace fsr::session;
using test_support::holds;

Json lineJson(const std::string& name, const std::string& source, const Json& values,
              const std::string& note) {
  return {{"name", name},          {"source", source},      {"part", "inside"},
          {"standard_pa", values}, {"added_pa", {0, 0, 0}}, {"note", note}};
}

// What train writes, with numbers of its own.
Json trainingJson() {
  const Json none = {nullptr, nullptr, nullptr};
  return {{"id", "df7d93648987"},
          {"provenance", {{"conditioning", {"conditioning: marked by an event"}}}},
          {"warnings", Json::array()},
          {"coverage", {{"thin", {"flat, 400+ kPa unloading: no scans"}}}},
          {"scores", {{"whole", {{"errors_pa", {{"whole", {{"all", {{"rmse", 17177.2}}}}}}}}}}},
          {"history",
           {{"choice", "History: none, since all cycles have one protocol; record cycles with two paces."}}},
          {"session", nullptr},
          {"temperature", {{"choice", "Temperature: none."}}},
          {"error_budget",
           {{"lines",
             {lineJson("resolution", "measured here", {51, 80, 119}, "one count"),
              lineJson("mount", "not assessed", none, "no surface was mounted more than once"),
              lineJson("in a socket", "not assessed", none, "shear, compliance, humidity")}},
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

// Steps: 1 mount, 2 and 3 cycles, 4 rest.
constexpr char kTwoCycles[] =
    "plan: day\nconditioning: {cycles: 0}\nrest: {before: 0, after: 5}\nrepeat_first: false\n"
    "surfaces: [{surface: flat}]\n"
    "program: [{cycles: {peak: 600000, rate: 20000, dwell_peak: 1, dwell_rest: 1, cycles: 2}}]\n";

DayReport fullDay() {
  const SessionPlan plan = example_plans::planFrom(kTwoCycles);
  ConductorState state = Conductor(plan).state();
  state.rejected = 1;
  state.steps = {StepState::kAccepted, StepState::kAccepted, StepState::kSkipped, StepState::kAccepted};
  state.remarks = {{1, Reason::kPeakMissed, "the highest pressure was 400 kPa"}};
  DayReport day = dayOf(plan, state, "/rig/day");
  day.check = {"rosrun fsr_pressure_map check_bag day_01_flat.bag", "", "bag\nFit for training.\n", nullptr};
  day.training = {"rosrun fsr_pressure_map train day_01_flat.bag", "", "all tables of train\n",
                  trainingJson()};
  day.discrepancy = {"rosrun fsr_pressure_map discrepancy day_01_flat.bag", "", "its first screen\n",
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
  page.element("h2", bad), page.element("h3", bad), page.element("p", bad), page.box({bad}),
      page.refusal(bad);
  page.list({bad}), page.table(bad, {bad}, {{bad}}), page.element("pre", bad),
      page.figure("<svg></svg>", bad);
  page.fold(bad), page.endFold();
  EXPECT_FALSE(holds(page.text(), {bad})) << page.text();
  EXPECT_TRUE(holds(page.text(), {"<td>&lt;b&gt;&amp;</td>"}));
}

TEST(HtmlPage, AlignsNumbersToTheRight) {
  HtmlPage page("");
  page.table("", {}, {{"12.5", "-", "-3.1 to 4.2", "95 % limits", "flat"}});
  EXPECT_TRUE(
      holds(page.text(),
            {"<tr><td class=\"number\">12.5</td><td class=\"number\">-</td><td>-3.1 to 4.2</td><td>95 % "
             "limits</td><td>flat</td></tr>"}));
}

TEST(DayPage, ShowsTheStateOfTheSessionAndWhatTheToolsPrinted) {
  EXPECT_TRUE(
      holds(dayHtml(fullDay()),
            {"held-out error 17.2 kPa (rms)", "k = 2 in the middle of the range 51.27 kPa",
             "3 of 4 steps accepted, 1 skipped", "1 attempt rejected",
             "rejected (peak_missed): the highest pressure was 400 kPa", "Bags: Fit for training.",
             "conditioning: marked by an event", "<pre>all tables of train\n</pre>",
             "<pre>its first screen\n</pre>", "<svg ", "rosrun fsr_pressure_map train day_01_flat.bag"}));
}

TEST(DayPage, TheFirstLineIsWhatTheMapIsGoodFor) {
  DayReport day = fullDay();
  day.training.result["good_for"] = "On a new mount of a known surface: 68 % within 6 kPa.";
  EXPECT_TRUE(holds(dayHtml(day),
                    {"<div class=\"box\">\n<p>On a new mount of a known surface: 68 % within 6 kPa.</p>"}));
}

// Behind a mistake that is made again and again, one that was made once is not to be overlooked.
TEST(DayPage, EqualRejectionsAreOneRowWithTheirNumber) {
  DayReport day = fullDay();
  day.state.remarks.clear();
  for (std::size_t i = 0; i < 13; ++i)
    day.state.remarks.push_back({1 + i % 2, Reason::kSheetOff, "silent at " + std::to_string(300 + i)});
  day.state.remarks.push_back({2, Reason::kLeak, "a leak"});
  const std::string page = dayHtml(day);
  EXPECT_TRUE(
      holds(page, {"<td class=\"number\">13</td><td>Cycle 1 of 2", "rejected (sheet_off): silent at 300</td>",
                   "<td class=\"number\">1</td><td>Cycle 2 of 2", "rejected (leak): a leak</td>"}));
  EXPECT_FALSE(holds(page, {"silent at 301"}));
}

std::string advicesOf(const std::string& page) {
  const std::size_t begin = page.find("<ul>", page.find("What to record next"));
  return page.substr(begin, page.find("</ul>", begin) - begin);
}

TEST(DayPage, GivesFiveAdvicesAtMostAndWhatMattersMostFirst) {
  DayReport day = fullDay();
  day.training.result["warnings"] = {"mount 5 differs"};
  for (int cell = 0; cell < 30; ++cell)
    day.training.result["coverage"]["thin"].push_back("cell " + std::to_string(cell));
  const std::string page = dayHtml(day), advices = advicesOf(page);
  std::size_t items = 0;
  for (std::size_t at = advices.find("<li>"); at != std::string::npos; at = advices.find("<li>", at + 1))
    ++items;
  EXPECT_EQ(items, 5u) << advices;
  EXPECT_EQ(advices.find("<ul>\n<li>What train warns of: mount 5 differs</li>"), 0u) << advices;
  EXPECT_TRUE(holds(advices, {"few scans or none: flat, 400+ kPa unloading: no scans (30 more below)</li>"}));
  EXPECT_TRUE(holds(page, {"<li>cell 29</li>"}));
  day.training = {"train", "too few cycles", "", nullptr};
  EXPECT_EQ(advicesOf(dayHtml(day)).find("<ul>\n<li>What train asks for: too few cycles</li>"), 0u);
}

TEST(DayPage, NeedsNoNetwork) {
  const std::string page = dayHtml(fullDay());
  for (const char* const part : {"http", "src=", "href", "<link", "<script", "<iframe", "url(", "@import"})
    EXPECT_FALSE(holds(page, {part})) << part;
}

TEST(DayPage, APartThatIsRefusedAppearsWithItsSentence) {
  DayReport day = fullDay();
  day.training = {"train", "train: day_01_flat.bag has 1 surface <1>", "", nullptr};
  day.discrepancy = {"discrepancy", "too few cycles", "", nullptr};
  const std::string page = dayHtml(day);
  EXPECT_TRUE(holds(page, {"train gave no result: train: day_01_flat.bag has 1 surface &lt;1&gt;",
                           "discrepancy gave no result: too few cycles"}));
  EXPECT_FALSE(holds(page, {"kPa (rms)"}));
  EXPECT_EQ(adviceOf(day, "discrepancy"), std::vector<std::string>{"too few cycles"});
}

TEST(DayPage, AResultOfAnotherFormIsNamedAndBreaksNothing) {
  DayReport day = fullDay();
  day.training.result = Json{{"id", "df7d93648987"}};
  const std::string page = dayHtml(day);
  EXPECT_TRUE(holds(page, {"What a tool wrote is incomplete", "Every step"}));
  day.training.result = trainingJson();
  day.training.result["scores"] = day.training.result["error_budget"] = nullptr;
  EXPECT_FALSE(holds(dayHtml(day), {"kPa (rms)"}));
}

TEST(DayAdvice, NamesWhatWasNotDone) {
  DayReport day = fullDay();
  ASSERT_EQ(adviceOf(day, "the state of the session").size(), 1u);
  EXPECT_TRUE(holds(adviceOf(day, "the state of the session")[0], {"Mount 1 on flat: Cycle 2 of 2: fill"}));
  day.state.steps.assign(4, StepState::kOpen);
  EXPECT_TRUE(holds(adviceOf(day, "the state of the session").at(0), {"none of its 4 steps was done"}));
}

TEST(DayAdvice, SaysWhatWouldAssessALineOfTheBudget) {
  const std::vector<std::string> advice = adviceOf(fullDay(), "train, error budget");
  ASSERT_EQ(advice.size(), 2u);
  EXPECT_TRUE(holds(advice[0], {"\"mount\" is not assessed: no surface was mounted more than once"}));
  EXPECT_TRUE(holds(advice[1], {"in a socket (shear, compliance, humidity)"}));
}

TEST(DayAdvice, CarriesTheSentencesOfTheTools) {
  EXPECT_EQ(adviceOf(fullDay(), "train, coverage"),
            std::vector<std::string>{"flat, 400+ kPa unloading: no scans"});
  EXPECT_TRUE(holds(adviceOf(fullDay(), "train").at(0), {"record cycles with two paces"}));
  const std::vector<std::string> told = adviceOf(fullDay(), "discrepancy");
  ASSERT_EQ(told.size(), 2u);
  EXPECT_TRUE(holds(told[1], {"repositioning, break_in: No surface was mounted twice", "remount"}));
}

TEST(DayAdvice, IsThatOfThePlanWhereNothingElseIsMissing) {
  DayReport day = fullDay();
  day.state.steps.assign(4, StepState::kAccepted);
  day.training.result["coverage"]["thin"] = Json::array();
  day.training.result["error_budget"]["lines"] = Json::array();
  day.training.result["history"] = nullptr;
  day.discrepancy.result["not_identifiable"] = day.discrepancy.result["first_screen"] = Json::array();
  const std::vector<Advice> all = whatToRecordNext(day);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].source, "plan_session");
}

}  // namespace
