// Every scheme from recordings through the file to the live map, on trained surfaces and on two others.
#include <unistd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "calibration/packed_tables.h"
#include "compensation/fit_scheme.h"
#include "compensation/training_statistics.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "support/synthetic_recording.h"

namespace fsr::calibration {
namespace {

using test_support::syntheticReading;
using test_support::syntheticRecording;
using test_support::SyntheticRig;
namespace flag = map::taxel_flag;

const std::vector<double> kTrained = {0, 7.7, 9, 11, 14, 20};  // [1/m]
const std::vector<double> kUnseen = {1 / 0.08, 1 / 0.06};

// Most of the effect of bending is reached at 10 1/m.
double saturating(double curvature) {
  return 15 * (1 - std::exp(-curvature / 6));
}

SyntheticRig paperLikeRig() {
  SyntheticRig rig;
  rig.surfaces.clear();
  for (const double curvature : kTrained) {
    rig.surfaces.push_back({"surface_" + std::to_string(rig.surfaces.size()), curvature});
  }
  rig.cycles = 5;
  rig.size = {1, 3};
  rig.felt_curvature = saturating;
  return rig;
}

const dataset::Recording& recording() {
  static const dataset::Recording made = syntheticRecording(paperLikeRig());
  return made;
}

const Calibration& train(compensation::Scheme scheme) {
  static std::map<compensation::Scheme, Calibration> trained;
  const auto found = trained.find(scheme);
  if (found != trained.end()) return found->second;
  CalibrationProblem problem{{recording()}, {}};
  problem.options.scheme = scheme;
  problem.options.regressor.grnn.bandwidth = 1.0 / 32;
  problem.options.choose_bandwidth = false;
  return trained[scheme] = calibrate(problem);
}

// Root mean squared error of the live map on one curvature, over taxels and pressures [Pa].
struct Live {
  double rmse = 0;
  double within = 0;  // share of the errors within one stated deviation
  std::uint16_t flags = 0;
};

Live live(Calibrator& calibrator, double curvature, const std::string& name = "new") {
  const SyntheticRig rig = paperLikeRig();
  calibrator.setSurface({name, 1, {{curvature, 0, 0}}, {}}, 0);
  Live result;
  map::PressureMap map;
  double number = 0;
  for (double pressure = 20e3; pressure <= 580e3; pressure += 1.37e3) {
    std::vector<std::uint16_t> counts;
    for (std::size_t taxel = 0; taxel < 3; ++taxel) {
      const double noise = 3.0 * std::sin(pressure);  // within the noise of the training
      counts.push_back(
          static_cast<std::uint16_t>(std::lround(syntheticReading(rig, taxel, curvature, pressure) + noise)));
    }
    calibrator.calibrate({rig.size, rig.full_scale, counts.data(), 3}, 0, map);
    for (std::size_t taxel = 0; taxel < 3; ++taxel) {
      const double error = map.pressure[taxel] - pressure;
      result.rmse += error * error;
      result.within += std::abs(error) <= map.deviation[taxel];
      result.flags |= map.flags[taxel];
      number += 1;
    }
  }
  return {std::sqrt(result.rmse / number), result.within / number, result.flags};
}

double unseen(compensation::Scheme scheme) {
  Calibrator calibrator(train(scheme).tables, {{1, 3}});
  double squares = 0;
  for (const double curvature : kUnseen) squares += std::pow(live(calibrator, curvature).rmse, 2);
  return std::sqrt(squares / 2);
}

double seen(compensation::Scheme scheme) {
  Calibrator calibrator(train(scheme).tables, {{1, 3}});
  double squares = 0;
  for (const double curvature : kTrained) squares += std::pow(live(calibrator, curvature).rmse, 2);
  return std::sqrt(squares / static_cast<double>(kTrained.size()));
}

TEST(Schemes, InterpolationIsBetterThanTheNearestClassBetweenClasses) {
  const double nearest = unseen(compensation::Scheme::kPerCurvature);
  EXPECT_LT(unseen(compensation::Scheme::kInterpolated), 0.6 * nearest);
  EXPECT_LT(unseen(compensation::Scheme::kCurvatureMap), 0.6 * nearest);
  EXPECT_LT(unseen(compensation::Scheme::kScaledCurvature), 0.9 * nearest);
}

TEST(Schemes, OnAClassAllSchemesAreAsGoodAsItsOwnModel) {
  const double nearest = seen(compensation::Scheme::kPerCurvature);
  EXPECT_NEAR(seen(compensation::Scheme::kInterpolated), nearest, 1.0);
  EXPECT_NEAR(seen(compensation::Scheme::kCurvatureMap), nearest, 1.0);
  EXPECT_LT(seen(compensation::Scheme::kScaledCurvature),
            1.2 * nearest);  // its neighbours have weight on a class too
  EXPECT_LT(seen(compensation::Scheme::kCurvatureInput), 1.05 * nearest);
  EXPECT_LT(seen(compensation::Scheme::kOneHot), 1.05 * nearest);
}

TEST(Schemes, SchemesWithoutCurvatureAreWorse) {
  const double nearest = seen(compensation::Scheme::kPerCurvature);
  EXPECT_GT(seen(compensation::Scheme::kBaseline), 2 * nearest);
  EXPECT_GT(seen(compensation::Scheme::kFlatOnly), 2 * nearest);
  EXPECT_GT(seen(compensation::Scheme::kFlatOrCurved), 1.2 * nearest);
}

TEST(Schemes, TheLawFollowsACurvedEffect) {
  // A case where linear interpolation fails: most of the effect between flat and 9 1/m comes with a small
  // curvature.
  const auto error = [&](compensation::Scheme scheme) {
    Calibrator calibrator(train(scheme).tables, {{1, 3}});
    return live(calibrator, 4.0).rmse;
  };
  EXPECT_LT(error(compensation::Scheme::kCurvatureMap), 0.8 * error(compensation::Scheme::kInterpolated));
}

TEST(Schemes, TheStatedDeviationHoldsOnUnseenCurvatures) {
  for (const compensation::Scheme scheme :
       {compensation::Scheme::kPerCurvature, compensation::Scheme::kInterpolated,
        compensation::Scheme::kCurvatureMap}) {
    Calibrator calibrator(train(scheme).tables, {{1, 3}});
    for (const double curvature : kUnseen) {
      EXPECT_GT(live(calibrator, curvature).within, 0.6)
          << compensation::schemeName(scheme) << ", " << curvature << " 1/m";
    }
  }
}

TEST(Schemes, TrainingPredictsTheErrorOnANewCurvature) {
  const UnseenScore nearest = train(compensation::Scheme::kPerCurvature).scores.unseen;
  const UnseenScore interpolated = train(compensation::Scheme::kInterpolated).scores.unseen;
  EXPECT_EQ(nearest.readings, 4u * 500 * 3);  // four inner surfaces
  EXPECT_LT(interpolated.rmse, 0.6 * nearest.rmse);
  EXPECT_GT(interpolated.rmse_percent.mean, 0.1);
  EXPECT_EQ(train(compensation::Scheme::kBaseline).scores.unseen.readings, 0u);
}

TEST(Schemes, RangesMergeClassesWithEqualEffect) {
  SyntheticRig rig = paperLikeRig();
  rig.felt_curvature = [](double curvature) { return curvature < 5 ? 0.0 : curvature < 12 ? 9.0 : 18.0; };
  CalibrationProblem problem{{syntheticRecording(rig)}, {}};
  problem.options.scheme = compensation::Scheme::kCurvatureRanges;
  problem.options.regressor.grnn.bandwidth = 1.0 / 32;
  problem.options.choose_bandwidth = false;
  const Calibration calibration = calibrate(problem);
  const auto same = [&](std::size_t a, std::size_t b) {
    return calibration.tables.table(0, a).pressure == calibration.tables.table(0, b).pressure;
  };
  EXPECT_FALSE(same(0, 1));
  EXPECT_TRUE(same(1, 2));
  EXPECT_TRUE(same(2, 3));
  EXPECT_FALSE(same(3, 4));
  EXPECT_TRUE(same(4, 5));
}

TEST(Schemes, RangesSeparateClassesWithDifferentEffect) {
  const Calibration ranges = train(compensation::Scheme::kCurvatureRanges),
                    each = train(compensation::Scheme::kPerCurvature);
  EXPECT_EQ(ranges.tables.table(0, 0).pressure, each.tables.table(0, 0).pressure);
}

TEST(Schemes, PerSurfaceUsesTheName) {
  SyntheticRig rig = paperLikeRig();
  rig.surfaces = {{"left_mould", 10.0}, {"right_mould", 10.1}};  // one class if pooled by curvature
  CalibrationProblem problem{{syntheticRecording(rig)}, {}};
  problem.options.scheme = compensation::Scheme::kPerSurface;
  const Calibration calibration = calibrate(problem);
  ASSERT_EQ(calibration.tables.classes.size(), 2u);
  Calibrator calibrator(calibration.tables, {{1, 3}});
  EXPECT_EQ(live(calibrator, 10.1, "left_mould").flags, 0);
  EXPECT_EQ(live(calibrator, 10.1, "a_third").flags, flag::kBetweenClasses);
}

TEST(Schemes, EverySchemeIsSavedLoadedAndUsedLive) {
  const std::string path = testing::TempDir() + "schemes_" + std::to_string(::getpid()) + ".h5";
  for (const std::string& name : compensation::schemeNames()) {
    const Calibration calibration = train(compensation::schemeFromName(name));
    saveCalibration(calibration, path);
    const Calibration loaded = loadCalibration(path);
    EXPECT_EQ(loaded.tables.scheme, calibration.tables.scheme);
    EXPECT_EQ(loaded.scores.unseen.readings, calibration.scores.unseen.readings) << name;
    Calibrator before(calibration.tables, calibration.layout), after(loaded.tables, loaded.layout);
    for (const double curvature : {0.0, 3.0, 9.0, 12.5, 20.0, 25.0}) {
      const Live here = live(before, curvature, "surface_2"), there = live(after, curvature, "surface_2");
      EXPECT_EQ(here.rmse, there.rmse) << name << ", " << curvature << " 1/m";
      EXPECT_EQ(here.within, there.within) << name;
      EXPECT_TRUE(std::isfinite(here.rmse)) << name;
    }
  }
  std::filesystem::remove(path);
}

TEST(Schemes, ParametersDoNotDependOnThreads) {
  for (const compensation::Scheme scheme :
       {compensation::Scheme::kScaledCurvature, compensation::Scheme::kCurvatureRanges,
        compensation::Scheme::kCurvatureMap}) {
    CalibrationProblem problem{{recording()}, {}};
    problem.options.scheme = scheme;
    problem.options.scores = false;
    problem.options.threads = 1;
    const Calibration one = calibrate(problem);
    problem.options.threads = 3;
    const Calibration three = calibrate(problem);
    EXPECT_EQ(one.tables.rule.length_scale, three.tables.rule.length_scale);
    EXPECT_EQ(one.tables.rule.law.gain, three.tables.rule.law.gain);
    EXPECT_EQ(one.tables.rule.unseen.deviation, three.tables.rule.unseen.deviation);
    EXPECT_EQ(one.tables.table(2, 3).pressure, three.tables.table(2, 3).pressure);
  }
}

// Logarithms of about -600 as floats: shares are right to 6e-5, of classes that differ by 100 kPa at most
// [Pa].
constexpr double kFloatLogarithms = 6.0;

// The live blend of kernels in float, compared with the model of two inputs in double.
TEST(Schemes, OnAClassTheLiveMapEqualsTheOfflineModel) {
  for (const compensation::Scheme scheme :
       {compensation::Scheme::kCurvatureInput, compensation::Scheme::kScaledCurvature}) {
    const Calibration& calibration = train(scheme);
    const compensation::TrainingStatistics& statistics = *calibration.statistics;
    compensation::SchemePlan plan = compensation::planScheme(scheme, statistics.classes);
    if (scheme == compensation::Scheme::kScaledCurvature)
      plan.curvature_scale = calibration.tables.rule.length_scale.at(0);
    regression::ClassReadings readings;
    readings.full_scale = statistics.full_scale;
    for (std::size_t k = 0; k < kTrained.size(); ++k) {
      readings.sums.emplace_back(statistics.full_scale);
      for (std::size_t s = 0; s < statistics.sections; ++s)
        readings.sums.back().add(statistics.cell(1, k, s));
    }
    const std::vector<regression::Fit> fits =
        compensation::fitScheme(plan, 1, readings, calibration.regressor);
    Calibrator calibrator(calibration.tables, {{1, 3}});
    map::PressureMap map;
    for (std::size_t k = 0; k < kTrained.size(); ++k) {
      calibrator.setSurface({"new", 1, {{kTrained[k], 0, 0}}, {}}, 0);
      for (std::uint16_t code = 1; code < 4095; code = static_cast<std::uint16_t>(code + 7)) {
        const std::vector<std::uint16_t> counts(3, code);
        calibrator.calibrate({{1, 3}, 4095, counts.data(), 3}, 0, map);
        EXPECT_NEAR(map.pressure[1], fits[k].pressure[code], kFloatLogarithms)
            << compensation::schemeName(scheme) << ", code " << code;
      }
    }
  }
}

TEST(Schemes, ClassesOfOneModelShareATable) {
  const Calibration& calibration = train(compensation::Scheme::kFlatOrCurved);
  EXPECT_EQ(calibration.tables.rule.model_of_class, (std::vector<std::size_t>{0, 1, 1, 1, 1, 1}));
  const PackedTables packed(calibration.tables);
  EXPECT_EQ(packed.table(2, 1), packed.table(2, 5));
  EXPECT_NE(packed.table(2, 0), packed.table(2, 5));
  EXPECT_EQ(packed.table(2, 5)[1234].pressure, calibration.tables.table(2, 5).pressure[1234]);
}

}  // namespace
}  // namespace fsr::calibration
