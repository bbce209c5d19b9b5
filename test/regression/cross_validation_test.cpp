#include "regression/cross_validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "regression/grnn/grnn.h"
#include "regression/readings.h"

namespace fsr::regression {
namespace {

using Section = std::vector<Reading>;

// Readings on the line 150 Pa a count from code 100 to 3900, with errors from `error` [Pa].
Section line(std::size_t number, std::mt19937& random, const std::function<double(int code)>& error) {
  Section section;
  for (std::size_t i = 0; i < number; ++i) {
    const int code = 100 + static_cast<int>(random() % 3800);
    section.push_back({static_cast<std::uint16_t>(code), 150.0 * code + error(code)});
  }
  return section;
}

CrossValidatedModel fit(const std::vector<Section>& sections) {
  std::vector<CodeStatistics> statistics;
  CodeHistogram training(kFullScale);
  for (const Section& section : sections) {
    statistics.push_back(statisticsOf(section));
    training.add(statistics.back());
  }
  const Fit whole = Grnn().fit(training);
  std::vector<std::vector<double>> held_out(sections.size());
  for (std::size_t k = 0; k < sections.size(); ++k) {
    training.subtract(statistics[k]);
    if (training.samples() > 0) held_out[k] = Grnn().fit(training).pressure;
    training.add(statistics[k]);
  }
  return assembleModel(statistics, kFullScale, whole, std::move(held_out), HeldOutDeviation::kYes);
}

// Share of the readings of each section within the deviation from the other sections.
double shareWithin(const std::vector<Section>& sections, const CrossValidatedModel& model) {
  double inside = 0, all = 0;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    for (const Reading& reading : sections[k]) {
      const double error = model.held_out[k].pressure[reading.code] - reading.pressure;
      inside += std::abs(error) <= model.held_out[k].deviation[reading.code];
      ++all;
    }
  }
  return inside / all;
}

TEST(CrossValidation, AHeldOutModelIsTrainedWithoutItsSection) {
  // One section is 9 kPa above the other: each model answers with the line of the other section.
  const std::vector<Section> sections = {{{100, 0.0}, {3000, 1e3}}, {{100, 9e3}, {3000, 10e3}}};
  const CrossValidatedModel model = fit(sections);
  EXPECT_EQ(model.held_out[0].pressure[100], 9e3);
  EXPECT_EQ(model.held_out[1].pressure[100], 0.0);
  EXPECT_EQ(model.table.pressure[100], 4.5e3f);
  EXPECT_NEAR(model.table.deviation[100], 9e3, 9e3 * 0.01);  // the width of a bin in the histogram of ratios
  EXPECT_EQ(model.table.lowest, 100);
  EXPECT_EQ(model.table.highest, 3000);
}

TEST(CrossValidation, NormalErrorsAreWithinOneDeviationAt68Percent) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<Section> sections;
  for (int k = 0; k < 5; ++k) {
    // the deviation increases with the code from 2 to 10 kPa
    sections.push_back(line(1500, random, [&](int code) { return (2e3 + 2.1 * code) * normal(random); }));
  }
  const CrossValidatedModel model = fit(sections);
  EXPECT_GT(shareWithin(sections, model), 0.63);
  EXPECT_LT(shareWithin(sections, model), 0.73);
  // The stated deviation follows the true one, plus the scatter of the model itself.
  EXPECT_NEAR(model.table.deviation[400] / (2e3 + 2.1 * 400), 1.1, 0.3);
  EXPECT_NEAR(model.table.deviation[3500] / (2e3 + 2.1 * 3500), 1.1, 0.3);
}

TEST(CrossValidation, ErrorsOfAHysteresisLoopAreWithinOneDeviationAt68Percent) {
  std::mt19937 random(8);
  std::vector<Section> sections;
  for (int k = 0; k < 5; ++k) {
    // loading and unloading are 15 kPa on either side: no reading is near the mean
    sections.push_back(line(1500, random, [&](int) {
      return (random() % 2 == 0 ? 15e3 : -15e3) + static_cast<double>(random() % 4000) - 2e3;
    }));
  }
  const CrossValidatedModel model = fit(sections);
  EXPECT_GT(shareWithin(sections, model), 0.63);
  EXPECT_LT(shareWithin(sections, model), 0.73);
}

TEST(CrossValidation, ARareCodeGetsTheDeviationOfAllCodes) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  std::vector<Section> sections;
  for (int k = 0; k < 5; ++k)
    sections.push_back(line(1500, random, [&](int) { return 5e3 * normal(random); }));
  sections[0].push_back({4090, 700e3});
  sections[1].push_back({4090, 700e3});
  const CrossValidatedModel model = fit(sections);
  const float typical = model.table.deviation[2000];
  EXPECT_GT(model.table.deviation[4090], 0.5f * typical);  // two equal readings do not show precision
  EXPECT_NEAR(model.table.deviation[0], typical, 0.2f * typical);
}

TEST(CrossValidation, TheDeviationIsAtLeastTheStepOfOneCount) {
  std::mt19937 random(10);
  std::vector<Section> sections;
  for (int k = 0; k < 5; ++k) sections.push_back(line(4000, random, [](int) { return 0.0; }));
  const CrossValidatedModel model = fit(sections);
  for (int code = 200; code <= 3800; ++code) EXPECT_GT(model.table.deviation[code], 130.0f) << code;
  for (const float deviation : model.table.deviation) EXPECT_GE(deviation, 1.0f);
}

TEST(CrossValidation, TheDeviationOfASingleSectionIsThatOfItsOwnReadings) {
  const CrossValidatedModel model = fit({{{100, 0.0}, {100, 8e3}, {2000, 50e3}}, {}});
  EXPECT_TRUE(model.held_out[0].pressure.empty());
  EXPECT_EQ(model.table.pressure[100], 4e3f);
  EXPECT_GT(model.table.deviation[100], 1e3f);
  for (const float pressure : model.table.pressure) EXPECT_TRUE(std::isfinite(pressure));
}

TEST(CrossValidation, AConstantPressureHasAPositiveDeviation) {
  const CrossValidatedModel model = fit({{{100, 5e3}, {101, 5e3}}, {{100, 5e3}, {102, 5e3}}});
  for (const float deviation : model.table.deviation) EXPECT_EQ(deviation, 1.0f);
  for (const float pressure : model.table.pressure) EXPECT_EQ(pressure, 5e3f);
}

TEST(HeldOutErrors, LeavingASectionOutRemovesItsErrors) {
  const std::vector<double> pressure(kFullScale + 1u, 0.0);
  HeldOutErrors errors(kFullScale);
  errors.addSection(statisticsOf({{100, 1e3}, {200, -1e3}}), pressure);
  errors.addSection(statisticsOf({{100, 9e3}, {200, 9e3}}), pressure);
  EXPECT_NEAR(errors.deviation(pressure, 1)[150], 1e3, 20.0);
  EXPECT_GT(errors.deviation(pressure)[150], 2e3f);
}

}  // namespace
}  // namespace fsr::regression
