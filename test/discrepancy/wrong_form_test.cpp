// An effect in the right place but not in the library's form gets the verdict wrong_form, neither named nor
// unknown.
#include <gtest/gtest.h>

#include "discrepancy/answer.h"

namespace fsr::discrepancy {
namespace {

TEST(WrongForm, IsSaidOfAFormThatIsNotInTheLibrary) {
  const DiscrepancyReport report = answerTo(planted::crossedLoop());
  ASSERT_EQ(report.verdict, Verdict::kWrongForm) << report.sentence;
  EXPECT_EQ(report.effects.at(0).id, "hysteresis");
}

// 0.28 of the span is more than any loop in a data sheet.
TEST(WrongForm, IsSaidOfASizeThatIsNotPlausible) {
  const DiscrepancyReport report =
      investigate(planted::problem(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.28, reach: 200000}\n"));
  ASSERT_EQ(report.verdict, Verdict::kWrongForm) << report.sentence;
  EXPECT_EQ(report.effects.at(0).id, "hysteresis");
}

// A relaxation of this size is larger than its sources know, a leak of all pressure behind the sheet is not:
// so the relaxation does not exclude the leak. It comes first, because its score is higher by more than the
// odds against such a size.
TEST(WrongForm, IsNotSaidWhereAPlausibleEffectResemblesIt) {
  const DiscrepancyReport report = investigate(planted::problem(
      planted::kTwoSpeeds, "  relaxation: {relaxed_share: 0.8, fastest: 30, slowest: 1000}\n"));
  ASSERT_EQ(report.verdict, Verdict::kAmbiguous) << report.sentence;
  EXPECT_EQ(report.credible_set.at(0), std::vector<std::string>{"relaxation"}) << report.sentence;
  EXPECT_TRUE(std::count(report.credible_set.begin(), report.credible_set.end(),
                         std::vector<std::string>{"seal_leak"}));
}

TEST(WrongForm, IsNotSaidOfALoopInTheLibrarysOwnForm) {
  const DiscrepancyReport report =
      investigate(planted::problem(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.1, reach: 200000}\n"));
  EXPECT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
}

// Bent surfaces are not mentioned where the same terms explain as much without them.
TEST(Unknown, SaysNoMoreCovariatesThanItMust) {
  DiscrepancyProblem problem = planted::crossedLoop();
  problem.options.leave_out = {"hysteresis", "creep", "time_skew", "seal_leak"};
  const DiscrepancyReport report = investigate(problem);
  ASSERT_EQ(report.verdict, Verdict::kUnknown) << report.sentence;
  EXPECT_EQ(report.depends_on, (std::vector<std::string>{"direction", "pressure"}));
}

}  // namespace
}  // namespace fsr::discrepancy
