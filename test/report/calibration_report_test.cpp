#include "report/calibration_report.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/squeezed.h"
#include "support/synthetic_recording.h"

namespace fsr::report {
namespace {

using test_support::syntheticRecording;
using test_support::SyntheticRig;

calibration::Calibration trained(compensation::Scheme scheme) {
  SyntheticRig rig;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_5cm", 20.0}};
  rig.peak = 300e3;
  calibration::CalibrationProblem problem{{syntheticRecording(rig)}, {}};
  problem.options.scheme = scheme;
  problem.options.date = "2024-05-06T07:08:09Z";
  return calibration::calibrate(problem);
}

// The line that starts with `start`.
std::string lineOf(const std::string& text, const std::string& start) {
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (line.rfind(start, 0) == 0) return line;
  }
  return "";
}

TEST(CalibrationReport, ShowsCoverageInBothUnitsOfCurvature) {
  const std::string text = coverageText(trained(compensation::Scheme::kPerCurvature).coverage);
  EXPECT_EQ(test_support::squeezed(lineOf(text, "cylinder_5cm")),
            "cylinder_5cm 20.00 0.200 500 5 1 40/45 40/40 85/85 85/80 0/0");
  EXPECT_NE(text.find("Few or no data:\n  no surface was loaded above 300 kPa\n"), std::string::npos);
}

TEST(CalibrationReport, ShowsScoresOfEachSurface) {
  const calibration::Calibration calibration = trained(compensation::Scheme::kPerCurvature);
  const std::string text = scoresText(calibration.scores, calibration.layout);
  EXPECT_NE(text.find("Another mount: not assessed"), std::string::npos);
  const std::size_t columns = calibration.layout.size.columns;
  const std::size_t taxel = calibration.scores.whole.worst_taxel;
  EXPECT_NE(lineOf(text, "all together")
                .find("(" + std::to_string(taxel / columns) + ", " + std::to_string(taxel % columns) + ")"),
            std::string::npos)
      << text;
  const calibration::Score& score = calibration.scores.conditions[1].score;
  char rmse[32];
  std::snprintf(rmse, sizeof(rmse), "%.1f", score.errors.whole.all.rmse / 1e3);
  EXPECT_NE(lineOf(text, "cylinder_5cm").find(rmse), std::string::npos);
  EXPECT_NE(lineOf(text, "all together"), "");
  EXPECT_NE(text.find("-/-"), std::string::npos);  // no reading above 400 kPa
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST(CalibrationReport, MarksSurfacesThatTheModelWasNotTrainedOn) {
  const std::string text = scoresText(trained(compensation::Scheme::kFlatOnly).scores, {{2, 3}});
  EXPECT_NE(text.find("cylinder_5cm *"), std::string::npos);
  EXPECT_NE(text.find("* the model used for this surface was not trained on it"), std::string::npos);
  EXPECT_EQ(scoresText(trained(compensation::Scheme::kBaseline).scores, {{2, 3}}).find('*'),
            std::string::npos);
}

TEST(CalibrationReport, PrintsTheLearnedParametersOfTheScheme) {
  calibration::Calibration calibration;
  EXPECT_EQ(learnedText(calibration), "");
  calibration.tables.scheme = compensation::Scheme::kScaledCurvature;
  calibration.tables.rule.length_scale = {1.25};
  EXPECT_EQ(learnedText(calibration), "Length scale of curvature: 1.25 1/m\n");
  calibration.tables.scheme = compensation::Scheme::kCurvatureRanges;
  calibration.tables.classes = {{"flat", {0.0}}, {"cylinder_13cm", {7.7}}, {"cylinder_11cm", {9.1}}};
  EXPECT_EQ(learnedText(calibration), "Curvature ranges: flat; cylinder_13cm; cylinder_11cm\n");
  calibration.tables.rule.model_of_class = {0, 1, 1};
  EXPECT_EQ(learnedText(calibration), "Curvature ranges: flat; cylinder_13cm, cylinder_11cm\n");
}

TEST(CalibrationReport, SaysThatScoresWereNotComputed) {
  EXPECT_EQ(scoresText({}, {}), "Scores were not computed.\n");
}

TEST(CalibrationReport, PrintsWarningsLineByLine) {
  calibration::Calibration calibration;
  EXPECT_EQ(warningsText(calibration), "");
  calibration.warnings = {"one", "two"};
  EXPECT_EQ(warningsText(calibration), "Warning: one\nWarning: two\n");
}

TEST(CalibrationReport, JsonHasTheSameNumbers) {
  const calibration::Calibration calibration = trained(compensation::Scheme::kPerCurvature);
  const auto json = nlohmann::json::parse(calibrationJson(calibration));
  EXPECT_EQ(json["scheme"], "per_curvature");
  EXPECT_EQ(json["provenance"]["date"], "2024-05-06T07:08:09Z");
  EXPECT_EQ(json["trained"]["pressure"][1], 300e3);
  EXPECT_TRUE(json["trained"]["temperature"][0].is_null());
  const auto& bent = json["scores"]["conditions"][1];
  const calibration::Score& score = calibration.scores.conditions[1].score;
  EXPECT_EQ(bent["r2"]["mean"], score.r2.mean);
  EXPECT_EQ(bent["errors_pa"]["bins"]["100-200 kPa"]["loading"]["rmse"], score.errors.bins[2].loading.rmse);
  EXPECT_EQ(json["coverage"]["conditions"][0]["loading"]["0-50 kPa"]["scans"],
            calibration.coverage.conditions[0].loading[0].scans);
  EXPECT_TRUE(nlohmann::json::parse(calibrationJson({}))["scores"].is_null());
}

}  // namespace
}  // namespace fsr::report
