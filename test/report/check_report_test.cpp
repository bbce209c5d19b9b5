#include "report/check_report.h"

#include <gtest/gtest.h>

#include "support/holds.h"

namespace {

using fsr::check::CheckResult;
using fsr::check::Verdict;

std::string checkText(const CheckResult& result) {
  return fsr::report::checkText(result, {});
}

// A check of 1,000 readings with an error of 3 kPa, where 4 kPa are expected.
CheckResult example() {
  CheckResult result;
  result.map.whole = {"", 1000, 710, 2, 0, -250e3, 9e9, 16e9};
  result.map.range = {0, 620e3};
  result.map.within = {6.2e3, 15.5e3};
  result.map.bags = {{"a.bag", 1, 0, 0, 0, 0, 25e6, 0}, {"b.bag", 1, 0, 0, 0, 0, 81e6, 0}};
  return result;
}

TEST(CheckReport, HasARowForAllReadings) {
  EXPECT_TRUE(test_support::holds(
      checkText(example()),
      {"all             1000           4.0        3.0       -0.2          71.0         0.2\n"}))
      << checkText(example());
}

TEST(CheckReport, OfASurfaceWithoutReadingsHasDashes) {
  CheckResult result = example();
  result.map.surfaces.emplace_back();
  result.map.surfaces.back().name = "flat";
  EXPECT_TRUE(test_support::holds(
      checkText(result),
      {"flat               0             -          -          -             -           -\n"}))
      << checkText(result);
  EXPECT_FALSE(test_support::holds(checkText(result), {"nan"}));
}

TEST(CheckReport, SaysWhatTheMapIsGoodForAndNamesTheWorstBag) {
  EXPECT_TRUE(test_support::holds(
      checkText(example()),
      {"\nGood for: 68 % of the readings of these bags err by at most 6.2 kPa (1.0 % of the range) and 95 % "
       "by at most 15.5 kPa (2.5 % of the range); worst bag: b.bag, RMSE 9.0 kPa; next: use it\n"}))
      << checkText(example());
}

TEST(CheckReport, SaysWhatTheBagsDoNotShow) {
  EXPECT_TRUE(test_support::holds(checkText(example()), {"\nStill good.\n"}));
  CheckResult result = example();
  result.map.not_shown = {"the sheet's memory: 100.0 % of the readings were not settled"};
  EXPECT_TRUE(test_support::holds(checkText(result), {"\nNot shown: the sheet's memory: 100.0 %"}));
  EXPECT_TRUE(test_support::holds(checkText(result), {"\nStill good as far as these bags show.\n"}));
}

TEST(CheckReport, EndsWithTheVerdictAndItsReasons) {
  CheckResult result = example();
  result.verdict = Verdict::kRecalibrate;
  result.reasons = {"errors are large", "taxels are dead: (0, 1)"};
  EXPECT_TRUE(test_support::holds(
      checkText(result), {"\nRecalibrate, because\n  - errors are large\n  - taxels are dead: (0, 1)\n"}));
  result.verdict = Verdict::kCorrected;
  result.reasons = {"it wins"};
  EXPECT_TRUE(test_support::holds(checkText(result), {"\nCorrected: it wins\n"}));
}

}  // namespace
