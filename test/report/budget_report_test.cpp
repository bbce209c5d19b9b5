#include "report/calibration_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/squeezed.h"

namespace fsr::report {
namespace {

using calibration::BudgetPart;
using calibration::BudgetSource;
using calibration::ErrorBudget;

const matrix::Layout kLayout{{1, 2}};

ErrorBudget example(std::uint64_t units) {
  ErrorBudget budget;
  budget.pressure = {62e3, 310e3, 558e3};
  budget.held_out = {3e3, 4e3, 6e3};
  budget.lines = {
      {"loading and unloading",
       BudgetSource::kMeasured,
       BudgetPart::kHeldOut,
       {2e3, 3e3, 5e3},
       {},
       "half of their difference"},
      {"mount", BudgetSource::kMeasured, BudgetPart::kPartly, {5e3, 4e3, 9e3}, {4e3, 3e3, 8e3}, "of 3"}};
  calibration::BudgetLine socket;
  socket.name = "in a socket";
  socket.note = "shear, compliance, humidity";
  budget.lines.push_back(socket);
  budget.combined = {5e3, 5e3, 10e3};
  budget.intervals.unit = calibration::IntervalUnit::kMounts;
  budget.intervals.bins[3] = {units, {1.1, units < 19 ? NAN : 2.25}, {0.70, units < 20 ? NAN : 0.951}};
  budget.intervals.whole = budget.intervals.bins[3];
  budget.intervals.scale.bins[3] = {300e3, 1.2, 0.61, 0.685};
  budget.intervals.scale.whole = {NAN, NAN, 0.62, 0.69};
  budget.intervals.by_direction = {{{0.69, 0.71}, {0.95, 0.96}}};
  budget.intervals.by_taxel = {{{0.74, 0.55}, {0.97, 0.93}}};
  return budget;
}

bool has(const std::string& text, const std::string& part) {
  return test_support::squeezed(text).find(part) != std::string::npos;
}

TEST(BudgetReport, SaysWhatIsInsideWhatIsAddedAndWhatIsNotKnown) {
  const std::string text = budgetText(example(24), kLayout);
  EXPECT_TRUE(has(text, "loading and unloading 2.00 3.00 5.00 measured here, inside: half")) << text;
  EXPECT_TRUE(has(text, "in a socket - - - not assessed: shear, compliance")) << text;
  EXPECT_TRUE(has(text, "+ mount 4.00 3.00 8.00\n")) << text;
  EXPECT_FALSE(has(text, "+ loading")) << text;
  EXPECT_TRUE(has(text, "combined, k = 2 10.00 10.00 20.00\n")) << text;
}

TEST(BudgetReport, RefusesAnIntervalThatTheUnitsDoNotAllow) {
  const std::string enough = budgetText(example(24), kLayout);
  EXPECT_FALSE(has(enough, "No 95 % interval")) << enough;
  EXPECT_TRUE(has(enough, "2.25 95.1 %")) << enough;
  const std::string few = budgetText(example(10), kLayout);
  EXPECT_TRUE(has(few, "No 95 % interval from 10 mounts: they allow at most 90.9 %, and 95 % needs 19."))
      << few;
}

TEST(BudgetReport, ShowsWhatTheDeviationOfTheMapIsMultipliedBy) {
  const std::string text = budgetText(example(24), kLayout);
  EXPECT_TRUE(has(text, "200-400 1.20 61.0 % 68.5 %\n")) << text;
  EXPECT_TRUE(has(text, "all - 62.0 % 69.0 %\n")) << text;
  ErrorBudget without = example(3);
  without.intervals.scale = {};
  EXPECT_TRUE(has(budgetText(without, kLayout), "that of the tables, from too few mounts for a factor"))
      << text;
  const Json json = budgetJson(example(24))["intervals"]["deviation_of_the_map"];
  EXPECT_EQ(json["bins"]["200-400 kPa"]["factor"], 1.2);
  EXPECT_TRUE(budgetJson(without)["intervals"]["deviation_of_the_map"].is_null());
}

// n = 24, k = ceil(25 x 0.95) = 24: 24 / 25, and beta.ppf([.05, .5, .95], 24, 1) of scipy.
TEST(BudgetReport, SaysWhatTheNumberOfUnitsGives) {
  const std::string text = budgetText(example(24), kLayout);
  EXPECT_TRUE(
      has(text,
          "From 24 mounts a 95 % interval contains 96.0 % of new readings on average, 88.3 % to 99.8 % in "
          "nine of ten trainings, and 97.2 % where all mounts are alike.\n"))
      << text;
}

TEST(BudgetReport, NamesTaxelsThatAreCoveredTooLittle) {
  const std::string text = budgetText(example(24), kLayout);
  EXPECT_TRUE(has(text, "55.0 % to 74.0 % by taxel (lowest: row 0, column 1)")) << text;
  EXPECT_TRUE(has(text, "they cover less than 58.3 % on 1 of 2 taxels")) << text;
}

TEST(BudgetReport, JsonHoldsTheSameInPascal) {
  const Json json = budgetJson(example(10));
  EXPECT_EQ(json["lines"][1]["name"], "mount");
  EXPECT_EQ(json["lines"][1]["source"], "measured here");
  EXPECT_EQ(json["lines"][1]["added_pa"][2], 8e3);
  EXPECT_EQ(json["combined_pa"][2], 10e3);
  EXPECT_EQ(json["intervals"]["unit"], "mounts");
  const auto read = nlohmann::json::parse(dump(json));
  EXPECT_TRUE(read["intervals"]["whole"]["factor_95"].is_null());
  EXPECT_TRUE(read["lines"][2]["standard_pa"][0].is_null());
}

TEST(BudgetReport, IsOneSentenceWithoutABudget) {
  EXPECT_EQ(budgetText({}, kLayout), "Error budget: none, since scores were not computed.\n");
  EXPECT_TRUE(budgetJson({}).is_null());
  EXPECT_TRUE(nlohmann::json::parse(calibrationJson({}))["error_budget"].is_null());
}

}  // namespace
}  // namespace fsr::report
