#include "discrepancy/prove/wording.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fsr::discrepancy {
namespace {

TEST(Wording, NamesTheEffectsThatTheRecordingsCannotShowAndTheirExperiments) {
  DiscrepancyReport report;
  report.verdict = Verdict::kNotIdentifiable;
  report.credible_set = {{"crosstalk"}, {"scan_skew"}};
  report.not_identifiable = {
      {"wear", "many_cycles", ""}, {"crosstalk", "uneven_load", ""}, {"scan_skew", "none", ""}};
  EXPECT_EQ(
      sentenceOf(report),
      "These recordings cannot show crosstalk or scan_skew; crosstalk needs the experiment uneven_load.");
}

// A share that is not known was once printed as "-9223372036854775808 %".
TEST(Wording, NeverPrintsAsANumberWhatIsNone) {
  EXPECT_EQ(
      weakPartText("flat", 0.124),
      "On flat the explanation is weak: fitted to all other parts, it explains 12 % of the common trace "
      "there.");
  EXPECT_EQ(weakPartText("flat", NAN),
            "On flat the explanation is not tested: it can explain nothing of the common trace there.");
}

}  // namespace
}  // namespace fsr::discrepancy
