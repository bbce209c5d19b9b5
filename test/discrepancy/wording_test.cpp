#include "discrepancy/prove/wording.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace fsr::discrepancy
