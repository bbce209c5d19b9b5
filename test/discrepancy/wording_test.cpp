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

// A loop is a pressure, not a share of a span that stands elsewhere; what explains more comes first.
TEST(Wording, TellsTheSizesOfAPairWithTheirMeaning) {
  DiscrepancyReport report;
  report.verdict = Verdict::kNamed;
  report.tested = {"hysteresis", "time_skew"};
  report.credible_set = {{"time_skew", "hysteresis"}};
  report.effects = {{"time_skew", "", {{"delay", 0.48, "s", {0.45, 0.51}}}, 9, 0.9},
                    {"hysteresis",
                     "",
                     {{"reach", 150e3, "Pa", {NAN, NAN}}, {"loop_width", 0.0195, "of span", {0.018, 0.021}}},
                     9,
                     0.9}};
  report.candidates = {{{"time_skew"}, false, "refused", 20, 0.01, 5, 0.3, 3e3},
                       {{"hysteresis"}, false, "refused", 90, 0.01, 7, 0.6, 9e3}};
  report.added.effects = {{"time_skew", {{"delay", 0.48}}},
                          {"hysteresis", {{"loop_width", 0.0195}, {"span", 620e3}}}};
  EXPECT_EQ(
      sentenceOf(report),
      "Best explanation among 2 effects tested, under this protocol: hysteresis (loop width 12.1 kPa, 95 "
      "% 11.2 to 13; reach 150 kPa) with time_skew (delay 0.48 s, 95 % 0.45 to 0.51).");
}

}  // namespace
}  // namespace fsr::discrepancy
