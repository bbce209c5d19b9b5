#include "report/calibration_report.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fsr::report {
namespace {

// More of everything than fits on a screen.
calibration::Calibration large() {
  calibration::Calibration calibration;
  calibration.scores.unseen.readings = 1;
  calibration.scores.session.choice = "Tare";
  calibration.scores.temperature.choice = "Temperature";
  calibration.scores.history.choice = "History";
  calibration.tables.scheme = compensation::Scheme::kScaledCurvature;
  calibration.tables.rule.length_scale = {1.25};
  for (int i = 0; i < 20; ++i) {
    const std::string number = std::to_string(i);
    calibration.coverage.conditions.emplace_back();
    calibration.coverage.conditions.back().condition.surface = "surface_" + number;
    calibration.coverage.conditions.back().scans = 100;
    calibration.scores.conditions.emplace_back();
    calibration.coverage.thin.push_back("thin " + number);
    calibration.warnings.push_back("warning " + number);
    calibration.provenance.conditioning.push_back("conditioning " + number);
  }
  calibration.budget.lines.emplace_back();
  calibration.layout.size = {1, 1};
  return calibration;
}

TEST(TrainingSummary, FitsOnAScreen) {
  const std::string text = trainingSummary(large());
  EXPECT_EQ(std::size_t(std::count(text.begin(), text.end(), '\n')), kSummaryLines - 3) << text;
  EXPECT_NE(text.find("\nall 20 "), std::string::npos) << text;
  EXPECT_NE(text.find("\nWarning: warning 2 (and 17 more: --details)\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
}

TEST(TrainingSummary, HasAllInTheDetails) {
  const std::string text = trainingDetails(large());
  EXPECT_NE(text.find("\nWarning: warning 19\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("more: --details"), std::string::npos) << text;
}

TEST(GoodFor, SaysThatWithoutScoresNothingIsKnown) {
  EXPECT_EQ(goodForText(calibration::Calibration{}).find("Good for: not known, because scores were not"), 0u);
}

}  // namespace
}  // namespace fsr::report
