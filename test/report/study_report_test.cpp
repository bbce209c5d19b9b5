#include "report/study/study_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "support/holds.h"
#include "support/squeezed.h"
#include "support/synthetic_recording.h"

namespace {

fsr::study::StudyProblem smallProblem() {
  test_support::SyntheticRig rig;
  rig.size = {1, 3};
  rig.surfaces = {{"flat", 0.0}, {"a \"bent\", sheet", 7.7}, {"cylinder_5cm", 20.0}};
  rig.scans_per_cycle = 40;
  fsr::study::StudyProblem problem{{test_support::syntheticRecording(rig)}, {}, "paper"};
  problem.plan.forest.trees = 2;
  problem.plan.resamples = 99;
  problem.plan.bandwidths = {1.0 / 128, 1.0 / 16};
  return problem;
}

const fsr::study::StudyResult& smallStudy() {
  static const fsr::study::StudyResult result = fsr::study::study(smallProblem());
  return result;
}

// Number of cells of a CSV line; commas in quotation marks do not count.
std::size_t cells(const std::string& line) {
  bool quoted = false;
  std::size_t number = 1;
  for (const char letter : line) {
    quoted = quoted != (letter == '"');
    number += letter == ',' && !quoted;
  }
  return number;
}

}  // namespace

TEST(StudyTables, HaveAsManyCellsInEachRowAsHeadings) {
  const auto tables = fsr::report::studyTables(smallStudy());
  EXPECT_EQ(tables.size(), 10u);
  for (const auto& [name, content] : tables) {
    std::istringstream lines(content);
    std::string headings, line;
    std::getline(lines, headings);
    std::size_t rows = 0;
    for (; std::getline(lines, line); ++rows) EXPECT_EQ(cells(line), cells(headings)) << name << ": " << line;
    EXPECT_GT(rows, 0u) << name;
  }
}

TEST(StudyTables, QuoteNamesAndLeaveUnknownNumbersEmpty) {
  const auto tables = fsr::report::studyTables(smallStudy());
  EXPECT_TRUE(test_support::holds(tables.at("response.csv"), {"\"a \"\"bent\"\", sheet\",7.7,"}));
  for (const auto& [name, content] : tables) EXPECT_FALSE(test_support::holds(content, {",nan"})) << name;
}

TEST(StudyTables, HaveEveryMethodOfEverySplit) {
  const fsr::study::StudyResult& result = smallStudy();
  const std::string scores = fsr::report::studyTables(result).at("scores.csv");
  std::size_t expected = 0;
  for (const auto& comparison : result.comparisons) expected += comparison.scores.size();
  for (const auto& split : result.splits) expected += split.scores.size();
  EXPECT_EQ(static_cast<std::size_t>(std::count(scores.begin(), scores.end(), '\n')), expected + 1);
}

TEST(StudyText, ShowsThePapersNumbersBesideOursAndStatesTheLimits) {
  const std::string text = fsr::report::studyText(smallStudy());
  EXPECT_TRUE(test_support::holds(text, {"6.93 +- 0.81", "As published, taxels treated as independent",
                                         "FITTED to the paper's tables", "n = 3 taxels"}));
}

TEST(StudyText, SaysWhyTheMemoryOfTheSheetIsNotAssessable) {
  const std::string text = fsr::report::studyText(smallStudy());
  EXPECT_TRUE(
      test_support::holds(text, {"\nhistory: not assessable: all cycles of the bags have one protocol"}))
      << text;
  const std::string json = fsr::report::studyJson(smallStudy());
  EXPECT_TRUE(test_support::holds(json, {"\"assessable\": false"})) << json;
}

TEST(StudyText, ShowsTheHistoryBesideTheStaticAnswerAndByProtocol) {
  fsr::study::StudyResult result = smallStudy();
  fsr::study::StudyScore score = result.splits.front().scores.front();
  score.id = "history";
  result.splits.push_back({"leave_protocol_out", "by protocol", {"slow"}, {score}});
  result.history.choice = "History: plays, the best on protocols that were left out.";
  result.history.protocols = {{"slow", {8e3, 4e3, 7e3, 5e3}, 6e3}};
  const std::string text = test_support::squeezed(fsr::report::studyText(result));
  EXPECT_TRUE(test_support::holds(text, {"leave_protocol_out: by protocol\n history ",
                                         "History: plays, the best", "8.00 4.00 7.00 5.00 6.00"}));
  EXPECT_FALSE(test_support::holds(text, {"not assessable"})) << text;
  EXPECT_TRUE(test_support::holds(fsr::report::studyJson(result), {"\"correction_alone\": 6000"})) << text;
  EXPECT_TRUE(test_support::holds(fsr::report::studyTables(result).at("scores.csv"),
                                  {"\"leave_protocol_out\",\"history\""}));
}

TEST(StudyText, ShowsTheErrorOfTheMapAgainstTheErrorOfTheCurvature) {
  fsr::study::StudyResult result = smallStudy();
  fsr::study::CurvatureErrorScore right, shorter, step;
  right.rmse = 20e3;
  right.rmse_percent = 3.5;
  right.rmse_of_class = {10e3, 20e3, 30e3};
  shorter = step = right;
  shorter.error.relative = -0.05;
  shorter.rmse = 25e3;
  shorter.moved = 8e3;
  shorter.stated = 6e3;
  step.error.absolute = 2;
  step.rmse = 31e3;
  result.curvature_errors = {{"interpolated", "Interpolated", {shorter, right, step}}};
  const std::string text = test_support::squeezed(fsr::report::studyText(result));
  EXPECT_TRUE(test_support::holds(text, {"RMSE [kPa]\n"
                                         " curvature is -5 % right +2 1/m\n"
                                         " interpolated 25.0 20.0 31.0\n",
                                         " interpolated 75 - -\n"}));
  const auto tables = fsr::report::studyTables(result);
  EXPECT_TRUE(test_support::holds(tables.at("curvature_errors.csv"),
                                  {"\"interpolated\",\"Interpolated\",-5,0,3.5,25,8,6,"}))
      << tables.at("curvature_errors.csv");
  EXPECT_TRUE(test_support::holds(tables.at("curvature_errors_by_surface.csv"),
                                  {"\"interpolated\",\"Interpolated\",0,2,\"cylinder_5cm\",30\n"}));
  const std::string json = fsr::report::studyJson(result);
  EXPECT_TRUE(test_support::holds(json, {"\"moved_pa\": 8000"})) << json;
  result.curvature_errors.clear();
  EXPECT_FALSE(test_support::holds(fsr::report::studyText(result), {"error of the curvature"}));
}

TEST(StudyText, NamesTheWorstTaxelByRowAndColumn) {
  fsr::study::StudyResult result = smallStudy();
  result.layout.size = {2, 2};
  result.comparisons.front().scores.front().worst_taxel = 3;
  EXPECT_TRUE(test_support::holds(fsr::report::studyText(result), {"  row 1, column 1 (taxel 3)\n"}));
}

TEST(StudyJson, HasThePublishedTestsAndEveryDecision) {
  const fsr::study::StudyResult& result = smallStudy();
  const std::string json = fsr::report::studyJson(result);
  EXPECT_TRUE(test_support::holds(json, {"\"as_published_taxels_treated_as_independent\""}));
  for (const fsr::study::StudyDecision& decision : result.decisions) {
    EXPECT_TRUE(test_support::holds(json, {"\"subject\": \"" + decision.subject + '"'}));
  }
  EXPECT_GE(result.decisions.size(), 12u);
}

TEST(StudyJson, WritesNullForAnUnknownNumber) {
  fsr::study::StudyResult result = smallStudy();
  result.comparisons.front().scores.front().r2_spread.mean = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(test_support::holds(fsr::report::studyJson(result), {"\"mean\": null"}));
}
