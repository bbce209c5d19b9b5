// The statements of a report must not contradict each other, whatever the verdict.

#include <gtest/gtest.h>

#include <cmath>

#include "discrepancy/planted.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "report/contradictions.h"

namespace fsr::discrepancy {
namespace {

using test_support::contradictions;
using Ids = std::vector<std::string>;

void expectConsistent(const DiscrepancyReport& report) {
  for (const std::string& sentence : contradictions(report))
    ADD_FAILURE() << sentence << "\n" << report.sentence;
}

DiscrepancyReport reportOf(const std::string& text, const std::string& hidden,
                           const DiscrepancyOptions& options = {}) {
  DiscrepancyProblem problem = planted::problem(text, hidden);
  problem.options = options;
  problem.options.threads = 1;
  return investigate(problem);
}

TEST(ReportStatements, OfNothingHidden) {
  const DiscrepancyReport report = reportOf(planted::kTwoSpeeds, "");
  ASSERT_EQ(report.verdict, Verdict::kNone) << report.sentence;
  expectConsistent(report);
  EXPECT_FALSE(report.smallest_seen.empty());
  EXPECT_EQ(report.scatter.size(), 3u);
  EXPECT_TRUE(std::isnan(report.at_map));
}

TEST(ReportStatements, OfAName) {
  const DiscrepancyReport report = reportOf(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.05}\n");
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  expectConsistent(report);
  EXPECT_GT(report.at_map, report.least_gap);
}

TEST(ReportStatements, OfTwoNames) {
  expectConsistent(
      reportOf(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.04}\n  time_skew: {delay: 0.3}\n"));
}

TEST(ReportStatements, OfAnAmbiguousVerdict) {
  const DiscrepancyReport report = reportOf(planted::kOneSpeed, "  hysteresis: {loop_width: 0.05}\n");
  ASSERT_EQ(report.verdict, Verdict::kAmbiguous) << report.sentence;
  expectConsistent(report);
  ASSERT_EQ(report.next_experiment.size(), 1u);
  EXPECT_GE(report.next_experiment.front().cycles, 5);
}

TEST(ReportStatements, OfFormsThatAreNotInTheLibrary) {
  DiscrepancyProblem problem = planted::crossedLoop();
  expectConsistent(investigate(problem));
  problem = planted::problem(planted::kTwoSpeeds, "  time_skew: {delay: 0.3}\n");
  problem.options.leave_out = {"time_skew"};
  expectConsistent(investigate(problem));
}

TEST(ReportStatements, OfFaultsOfTaxels) {
  for (const char* fault : {"  dead_taxel: {taxels: 1, first: 5, start: 700}\n",
                            "  row_fault: {share: 0.04, line: 1, burst: 3, depth: 0.7}\n"})
    expectConsistent(reportOf(planted::kTwoSpeeds, fault));
  DiscrepancyOptions without;
  without.leave_out = {"row_fault", "stuck_taxel", "dead_taxel"};
  expectConsistent(
      reportOf(planted::kTwoSpeeds, "  row_fault: {share: 0.04, line: 1, burst: 3, depth: 0.7}\n", without));
}

TEST(ReportStatements, OfTooFewCyclesToHoldAnyOut) {
  std::string few = planted::kOneSpeed;
  few.replace(few.find("cycles: 8"), 9, "cycles: 2");
  for (const char* hidden : {"", "  hysteresis: {loop_width: 0.05}\n"}) {
    const DiscrepancyReport report = reportOf(few, hidden);
    expectConsistent(report);
    EXPECT_TRUE(std::isnan(report.gap.before));
    EXPECT_TRUE(report.effects.empty());
  }
}

// The loop is 5 % of full scale, so with a least gap of 200 kPa it does not matter.
TEST(ReportStatements, OfAnEffectBelowTheLeastGap) {
  DiscrepancyOptions options;
  options.least_gap = 200e3;
  options.ask = {"hysteresis"};
  const DiscrepancyReport report =
      reportOf(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.05}\n", options);
  ASSERT_EQ(report.verdict, Verdict::kNone) << report.sentence;
  expectConsistent(report);
  ASSERT_FALSE(report.too_small.empty());
  EXPECT_EQ(report.least_gap, 200e3);
  EXPECT_NE(report.sentence.find("least gap"), std::string::npos) << report.sentence;
}

TEST(ReportStatements, AnswerTheQuestionsOfTheUserWhateverIsFound) {
  DiscrepancyOptions options;
  options.ask = {"crosstalk", "hysteresis", "time_skew", "white_noise"};
  const DiscrepancyReport found =
      reportOf(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.05}\n", options);
  expectConsistent(found);
  Ids answers;
  for (const Answer& answer : found.answers) answers.push_back(answer.answer);
  EXPECT_EQ(answers, (Ids{"not_identifiable", "found", "excluded", "in_simulation"}));
  EXPECT_GT(found.answers.at(2).at_map, 0);
  const DiscrepancyReport nothing = reportOf(planted::kTwoSpeeds, "", options);
  EXPECT_EQ(nothing.verdict, Verdict::kNotIdentifiable) << nothing.sentence;
  expectConsistent(nothing);
}

TEST(ReportStatements, ARepeatedSearchKeepsTheFloor) {
  DiscrepancyOptions options;
  const std::string hidden = "  time_skew: {delay: 0.3}\n";
  const DiscrepancyReport once = reportOf(planted::kTwoSpeeds, hidden, options);
  options.repeat = true;
  const DiscrepancyReport repeated = reportOf(planted::kTwoSpeeds, hidden, options);
  expectConsistent(repeated);
  EXPECT_EQ(once.gap.before, repeated.gap.before);
  EXPECT_EQ(once.gap.floor, repeated.gap.floor);
  EXPECT_NE(repeated.gap.floor, repeated.gap.after);
}

}  // namespace
}  // namespace fsr::discrepancy
