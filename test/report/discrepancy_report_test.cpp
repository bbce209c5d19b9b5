#include "report/discrepancy_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/example_discrepancy.h"

namespace fsr::report {
namespace {

using test_support::exampleDiscrepancy;

void expectHolds(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << " in:\n" << text;
}

// What is missing, how sure the name is, what it costs, whether the gap shrank, what to record next.
TEST(DiscrepancyText, AnswersInOrder) {
  const std::string text = discrepancyText(exampleDiscrepancy());
  std::size_t at = 0;
  for (const char* part :
       {"Missing: Best explanation among 3 effects tested",
        "How sure: Not excluded: hysteresis. Best of these 3 effects, under this protocol; all others are "
        "excluded at 95 %.",
        "by chance is 0.0033 (corrected for the search; level 0.01)",
        "Asked: crosstalk: not_identifiable. The static curve takes all of it.",
        "Cost: 20 kPa at the map (rms) if it is left out; the least gap is 1.2 kPa.",
        "21.0 kPa in a ramp (5.0 with it), 18.0 kPa in a stance of 0.6 s (4.0 with it), 9.0 kPa in ten "
        "minutes",
        "Scatter: The gain changes from cycle to cycle by 1.2 % (standard deviation, 95 % 0.9 to 1.6 %): 3.1 "
        "kPa at the map, 71 % of the variance of the noise. The reading wanders within a cycle by 0.11 % of "
        "full scale",
        "of the noise. The zero changes from cycle to cycle by less than 0.04 % of full scale.",
        "Gap, rms on hold-out data: 3.10 % FS (19.2 kPa) before, 0.80 % FS (5.0 kPa) after, floor 0.60 % FS",
        "between cycles 0.71 % FS", "closed 92 % (90 to 94 %)", "Held out by: cycles, condition",
        "Recompute the gap: rosrun fsr_pressure_map simulate --gap found/verdict.yaml --drive 1_flat.bag",
        "Next experiment: Run five cycles", "crosstalk (uneven_load), wear (many_cycles)",
        "On each surface: flat 3.00 % FS before, 0.70 % FS after; cylinder_7cm 3.20 % FS before",
        "Common trace explained on each condition with sizes fitted to the others: 88 % (flat 90 %, "
        "cylinder_7cm 86 %)",
        "used 3 times"}) {
    const std::size_t found = text.find(part, at);
    ASSERT_NE(found, std::string::npos) << part << " after\n" << text.substr(0, at) << "in\n" << text;
    at = found;
  }
}

TEST(DiscrepancyText, SaysWhatNoneExcludes) {
  discrepancy::DiscrepancyReport report;
  report.sentence = "Among 2 effects tested, these recordings show none that is missing.";
  report.p = 0.42;
  report.least_gap = 600;
  report.smallest_seen = {{"creep", 2400}, {"drift", NAN}, {"hysteresis", 700}};
  report.too_small = {{"time_skew", 0.0033, 310, 600}};
  expectHolds(
      discrepancyText(report),
      {"by chance is 0.42",
       "Excluded: Would have been seen, from this size at the map: 0.7 kPa: hysteresis; 2.4 kPa: creep.",
       "time_skew is visible, but with 0.31 kPa it is below the least gap of 0.6 kPa."});
  EXPECT_EQ(discrepancyText(report).find("Cost"), std::string::npos);
}

TEST(DiscrepancyText, BeginsWithTheScatterWhereThatIsLargest) {
  discrepancy::DiscrepancyReport report = exampleDiscrepancy();
  EXPECT_EQ(discrepancyText(report).find("Missing: "), 0u);
  report.scatter.front().at_map = 1.1 * report.at_map;
  const std::string text = discrepancyText(report);
  EXPECT_EQ(text.find("Scatter, more than what is missing: The gain changes from cycle to cycle by"), 0u);
  EXPECT_EQ(text.find("Scatter: "), std::string::npos) << text;
}

// The error grew where the curves are flat.
TEST(DiscrepancyText, SaysWhereTheGapFallsAsAReadingAndRisesAsAPressure) {
  discrepancy::DiscrepancyReport report = exampleDiscrepancy();
  report.gap.after_pressure = 21e3;
  expectHolds(discrepancyText(report), {"3.10 % FS before, 0.80 % FS after, floor 0.60 % FS (neighbouring",
                                        "As a pressure it rises, from 19.2 to 21.0 kPa:"});
}

TEST(DiscrepancyText, PrintsNoNumberWhereThereIsNone) {
  discrepancy::DiscrepancyReport report = exampleDiscrepancy();
  report.gap.foretold = {{"condition", NAN, {NAN, NAN}, {{"flat", NAN}, {"bent", 0.86}}}};
  expectHolds(discrepancyText(report), {"with sizes fitted to the others: - (flat -, bent 86 %)."});
}

TEST(DiscrepancyText, LeavesOutAbsentParts) {
  const discrepancy::DiscrepancyReport nothing;
  const std::string text = discrepancyText(nothing);
  EXPECT_NE(text.find("Not measured, because nothing was held out"), std::string::npos);
  EXPECT_NE(text.find("Record at least 10 cycles"), std::string::npos);
  EXPECT_EQ(text.find("0.00"), std::string::npos) << text;
  for (const char* part : {"Recompute", "On each surface", "Not excluded", "Not testable", "Cost", "Scatter",
                           "Asked", "Excluded", "times by now", "Held out"})
    EXPECT_EQ(text.find(part), std::string::npos) << part;
}

TEST(DiscrepancyJson, HasEveryNumberAndNullForNone) {
  const auto json = nlohmann::json::parse(discrepancyJson(exampleDiscrepancy()));
  EXPECT_EQ(json["verdict"], "named");
  EXPECT_EQ(json["gap"]["before"], 0.031);
  EXPECT_EQ(json["gap"]["floor_bracket"][1], 0.0071);
  EXPECT_EQ(json["gap"]["surfaces"][1]["after"], 0.009);
  EXPECT_EQ(json["gap"]["covered"][1]["pressure_pa"][1], 615e3);
  EXPECT_EQ(json["gap"]["left_out"], 12);
  EXPECT_EQ(json["recompute"].get<std::string>().find("rosrun"), 0u);
  EXPECT_EQ(json["gap"]["closed_interval"][1], 0.94);
  EXPECT_EQ(json["effects"][0]["parameters"][0]["interval"][0], 0.058);
  EXPECT_EQ(json["candidates"].size(), 3u);
  EXPECT_EQ(json["covariates"][0]["adjusted_p"], 3e-3);
  EXPECT_EQ(json["first_screen"][0]["title"], "Missing");
  EXPECT_EQ(json["at_map_pa"], 20e3);
  EXPECT_EQ(json["scatter"][0]["interval"][1], 0.016);
  EXPECT_EQ(json["scatter"][1]["seen"], false);
  EXPECT_EQ(json["answers"][0]["answer"], "not_identifiable");
  EXPECT_EQ(json["next_experiment"]["cycles"], 20);
  EXPECT_EQ(json["smallest_seen"][0]["at_map_pa"], 1300);
  EXPECT_TRUE(json["smallest_seen"][2]["at_map_pa"].is_null());
  EXPECT_EQ(json["options"]["level"], 0.01);
  EXPECT_TRUE(json["options"]["least_gap_pa"].is_null());
  EXPECT_EQ(json["gap"]["foretold"][0]["parts"][1]["part"], "cylinder_7cm");
  EXPECT_EQ(json["curves"][0]["at"].size(), 20u);
  const discrepancy::DiscrepancyReport nothing;
  EXPECT_TRUE(nlohmann::json::parse(discrepancyJson(nothing))["gap"]["before"].is_null());
  EXPECT_TRUE(json["in_use"][2]["after_pa"].is_null());
  EXPECT_EQ(json["inputs"][1]["show_opened"], 3);
  EXPECT_TRUE(nlohmann::json::parse(discrepancyJson(nothing))["next_experiment"].is_null());
}

TEST(DiscrepancyTables, AreOneForEachFigureWithUnitsInTheirHeadings) {
  const auto tables = discrepancyTables(exampleDiscrepancy());
  EXPECT_EQ(tables.size(), 4u);
  const std::string& curve = tables.at("residual_pressure.csv");
  EXPECT_EQ(curve.substr(0, curve.find('\n')),
            "\"pressure [Pa]\",before [% FS],after [% FS],standard error [% FS]");
  EXPECT_EQ(std::count(curve.begin(), curve.end(), '\n'), 21);
  expectHolds(tables.at("gap.csv"), {"before,3.1,2.9", "floor,0.6,"});
  expectHolds(tables.at("candidates.csv"), {"hysteresis + creep,refused,809,0.0033,14.2,93.5,21000"});
}

TEST(DiscrepancyTables, LeaveTheCellOfAMissingValueEmpty) {
  discrepancy::DiscrepancyReport report = exampleDiscrepancy();
  report.gap.after = NAN;
  report.gap.after_interval = {NAN, NAN};
  report.gap.after_pressure = NAN;
  expectHolds(discrepancyTables(report).at("gap.csv"), {"after,,,,\n"});
}

TEST(FitRemarks, GiveTheIntervalOfAFittedValue) {
  const simulation::ValueRemarks remarks = fitRemarks(exampleDiscrepancy());
  EXPECT_EQ(remarks.at("hysteresis.loop_width"),
            "fitted, 95 % interval 0.058 to 0.067 fraction of full scale");
}

TEST(ConfirmationText, SaysPassedOrNotAndTheRival) {
  discrepancy::Confirmation confirmation;
  confirmation.passed = false;
  confirmation.sentence = "The loop did not keep its width.";
  confirmation.size = 0.4;
  confirmation.interval = {0.3, 0.5};
  confirmation.best_rival = "creep";
  expectHolds(confirmationText(confirmation),
              {"Not confirmed: The loop", "relative to the prediction: 0.40", "more: creep"});
  expectHolds(confirmationYaml(confirmation, "abc", {{"new.bag", "def", 10, 0}}),
              {"passed: false", "size: 0.4", "best_rival: creep", "prediction_hash: abc", "sha256: def"});
}

}  // namespace
}  // namespace fsr::report
