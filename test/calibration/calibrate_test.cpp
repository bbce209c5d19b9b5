#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/same_tables.h"
#include "compensation/training_statistics.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "regression/regressors.h"
#include "support/holds.h"
#include "support/synthetic_recording.h"

namespace fsr::calibration {
namespace {

using test_support::syntheticReading;
using test_support::syntheticRecording;
using test_support::SyntheticRig;

SyntheticRig threeSurfaces() {
  SyntheticRig rig;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_10cm", 10.0}, {"cylinder_5cm", 20.0}};
  rig.cycles = 10;
  return rig;
}

Calibration train(const std::vector<dataset::Recording>& recordings, compensation::Scheme scheme,
                  unsigned threads = 2) {
  CalibrationProblem problem{recordings, {}};
  problem.options.scheme = scheme;
  problem.options.choose_bandwidth = false;
  problem.options.threads = threads;
  problem.options.date = "2024-05-06T07:08:09Z";
  return calibrate(problem);
}

TEST(Calibrate, RecoversTheCurveOfEachTaxelAndSurface) {
  const SyntheticRig rig = threeSurfaces();
  const Calibration calibration = train({syntheticRecording(rig)}, compensation::Scheme::kPerCurvature);
  ASSERT_EQ(calibration.tables.classes.size(), 3u);
  for (std::size_t taxel = 0; taxel < rig.size.taxels(); ++taxel) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double curvature = calibration.tables.classes[c].at(taxel);
      for (const double pressure : {100e3, 250e3, 500e3}) {
        const auto code =
            static_cast<std::size_t>(std::lround(syntheticReading(rig, taxel, curvature, pressure)));
        // 10 counts of noise are about 4 kPa
        EXPECT_NEAR(calibration.tables.table(taxel, c).pressure[code], pressure, 6e3);
      }
    }
  }
}

// Putting the matrix on again changes its gain: the deviation must cover it where training saw two mounts.
TEST(Calibrate, PutsTheErrorOfAnotherMountIntoTheDeviation) {
  const auto mounted = [](std::uint32_t mount, double gain) {
    SyntheticRig rig = threeSurfaces();
    rig.cycles = 6;
    rig.seed = mount;
    dataset::Recording recording = syntheticRecording(rig);
    recording.name = "mount_" + std::to_string(mount) + ".bag";
    for (matrix::Surface& surface : recording.conditions) surface.mount = mount;
    for (std::uint16_t& count : recording.counts) count = static_cast<std::uint16_t>(gain * count);
    return recording;
  };
  const auto deviation = [](const Calibration& calibration) {
    return double(calibration.tables.table(0, 1).deviation[2000]);
  };
  const Calibration one = train({mounted(1, 1.0)}, compensation::Scheme::kInterpolated);
  EXPECT_EQ(one.scores.remount.readings, 0u);  // not assessed
  const Calibration two = train({mounted(1, 1.0), mounted(2, 0.95)}, compensation::Scheme::kInterpolated);
  EXPECT_EQ(two.scores.remount.readings, 2u * 3 * 600 * 6);
  // 5 % of the reading are 10 % of the pressure, about 35 kPa (rms).
  EXPECT_GT(two.scores.remount.rmse, 20e3);
  EXPECT_LT(two.scores.remount.rmse, 50e3);
  EXPECT_GT(two.scores.remount.rmse, 1.3 * two.scores.whole.errors.whole.all.rmse);
  EXPECT_GT(deviation(two), 3 * deviation(one));
  // A third mount, between them in size: two thirds of its readings are within one deviation or more.
  const dataset::Recording third = mounted(3, 0.96);
  std::size_t within = 0;
  for (std::size_t i = 0; i < third.scans(); ++i) {
    const regression::CodeTable& table = two.tables.table(0, third.condition[i]);
    const std::uint16_t code = third.scan(i)[0];
    within += std::abs(double(table.pressure[code]) - third.pressure[i]) <= double(table.deviation[code]);
  }
  EXPECT_GT(double(within), 0.6 * double(third.scans()));
  // A surface with one mount gets the deviation of the others.
  dataset::Recording flat = mounted(2, 0.95);
  for (matrix::Surface& surface : flat.conditions) surface.mount = surface.name == "flat" ? 2 : 1;
  const Calibration some = train({mounted(1, 1.0), flat}, compensation::Scheme::kInterpolated);
  EXPECT_EQ(some.scores.remount.readings, 2u * 600 * 6);
}

// Mounts are also recorded at rest only, for the shape of the sheet. Without a loaded one, they predict
// nothing.
TEST(Calibrate, AsksNoErrorOfMountsAtRest) {
  SyntheticRig rig = threeSurfaces();
  rig.cycles = 6;
  dataset::Recording loaded = syntheticRecording(rig);
  rig.seed = 2;
  dataset::Recording rest = syntheticRecording(rig);
  rest.name = "rest.bag";
  for (matrix::Surface& surface : loaded.conditions) surface.mount = 1;
  for (matrix::Surface& surface : rest.conditions) surface.mount = 2;
  for (double& pressure : rest.pressure) pressure *= 0.4;
  const Calibration calibration = train({loaded, rest}, compensation::Scheme::kInterpolated);
  EXPECT_EQ(calibration.scores.remount.readings, 0u);
  for (double& pressure : rest.pressure) pressure *= 1.5;
  EXPECT_GT(train({loaded, rest}, compensation::Scheme::kInterpolated).scores.remount.readings, 0u);
}

TEST(Calibrate, PerCurvatureIsBestOnABentSurface) {
  const dataset::Recording recording = syntheticRecording(threeSurfaces());
  const auto rmse = [&](compensation::Scheme scheme, std::size_t condition) {
    return train({recording}, scheme).scores.conditions.at(condition).score.errors.whole.all.rmse;
  };
  for (const std::size_t bent : {std::size_t{1}, std::size_t{2}}) {
    EXPECT_LT(rmse(compensation::Scheme::kPerCurvature, bent),
              0.5 * rmse(compensation::Scheme::kBaseline, bent));
    EXPECT_LT(rmse(compensation::Scheme::kPerCurvature, bent),
              0.5 * rmse(compensation::Scheme::kFlatOnly, bent));
  }
  EXPECT_DOUBLE_EQ(rmse(compensation::Scheme::kPerCurvature, 0), rmse(compensation::Scheme::kFlatOnly, 0));
}

// One taxel, one surface, five cycles of 40 scans, without random numbers, so that numpy can reproduce it.
dataset::Recording plainRecording() {
  SyntheticRig rig;
  rig.size = {1, 1};
  rig.scans_per_cycle = 40;
  rig.surfaces = {{"flat", 0.0}};
  dataset::Recording recording = syntheticRecording(rig);
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    recording.pressure[i] *= (600e3 - 7e3 * static_cast<double>(i / 40)) / 600e3;
    const double curve = std::round(3000.0 * std::sqrt(recording.pressure[i] / 600e3));
    recording.counts[i] = static_cast<std::uint16_t>(curve + static_cast<double>((7 * i) % 23 + 10));
  }
  return recording;
}

TEST(Calibrate, ScoresAgreeWithNumpy) {
  // /usr/bin/python3, numpy 1.24.2:
  //   i = np.arange(200); phase = i/40 - np.floor(i/40); P = (600e3 - 7e3*(i//40)) * (1 - abs(2*phase - 1))
  //   c = np.round(3000*np.sqrt(P/600e3)) + (7*i) % 23 + 10; for each k of 5: tr = i//40 != k; te = ~tr
  //   s = c[tr].std(ddof=1)/128; d2 = (c[te][:,None] - c[tr][None,:])**2
  //   w = np.exp(-(d2 - d2.min(1)[:,None])/(2*s*s)); e = (w*P[tr]).sum(1)/w.sum(1) - P[te]
  //   1 - (e**2).sum()/((P[te] - P[te].mean())**2).sum(), 100*np.sqrt((e**2).mean())/np.ptp(P[te])
  const Calibration calibration = train({plainRecording()}, compensation::Scheme::kPerCurvature);
  const Score& score = calibration.scores.conditions.at(0).score;
  constexpr double kFloats = 1e-6;  // errors are stored as float
  EXPECT_EQ(score.readings, 200u);
  EXPECT_NEAR(score.r2.mean, 0.9996377810800968, 1e-12);
  EXPECT_NEAR(score.rmse_percent.mean, 0.546316463181373, 1e-10);
  EXPECT_NEAR(score.errors.whole.all.bias / 138.91794813221003, 1.0, 1e-4);
  EXPECT_NEAR(score.errors.whole.all.rmse / 3229.6072795833493, 1.0, kFloats);
  EXPECT_NEAR(score.errors.whole.all.p95_absolute / 6223.0353963733605, 1.0, kFloats);
  EXPECT_EQ(score.errors.bins[3].all.count, 70u);  // 200 to 400 kPa
  EXPECT_NEAR(score.errors.bins[3].all.rmse / 3121.2481058056596, 1.0, kFloats);
  EXPECT_EQ(score.worst_taxel, 0u);
  EXPECT_DOUBLE_EQ(calibration.scores.whole.rmse_percent.mean, score.rmse_percent.mean);
}

TEST(Calibrate, ChoosesTheSameBandwidthOnAnyNumberOfThreads) {
  CalibrationProblem problem{{syntheticRecording(threeSurfaces())}, {}};
  problem.options.threads = 1;
  const Calibration one = calibrate(problem);
  problem.options.threads = 4;
  const Calibration four = calibrate(problem);
  EXPECT_EQ(one.regressor.grnn.bandwidth, four.regressor.grnn.bandwidth);
  expectSameTables(one, four);
}

TEST(Calibrate, GivesTheSameResultOnAnyNumberOfThreads) {
  const dataset::Recording recording = syntheticRecording(threeSurfaces());
  const Calibration one = train({recording}, compensation::Scheme::kPerCurvature, 1);
  const Calibration four = train({recording}, compensation::Scheme::kPerCurvature, 4);
  expectSameTables(one, four);
  EXPECT_EQ(one.scores.whole.errors.whole.all.rmse, four.scores.whole.errors.whole.all.rmse);
  EXPECT_EQ(one.scores.whole.within_one_deviation, four.scores.whole.within_one_deviation);
}

TEST(Calibrate, GivesTheSameTablesInAnyOrderOfTheBags) {
  SyntheticRig rig = threeSurfaces();
  rig.seed = 2;
  const dataset::Recording first = syntheticRecording(rig);
  rig.seed = 3;
  rig.surfaces.pop_back();
  const dataset::Recording second = syntheticRecording(rig);
  expectSameTables(train({first, second}, compensation::Scheme::kPerCurvature),
                   train({second, first}, compensation::Scheme::kPerCurvature));
  expectSameTables(train({first, second}, compensation::Scheme::kBaseline),
                   train({second, first}, compensation::Scheme::kBaseline));
}

TEST(Calibrate, TheStatedDeviationHoldsForHeldOutReadings) {
  SyntheticRig rig = threeSurfaces();
  rig.loop = 60.0;  // loading and unloading are two curves
  const Calibration calibration = train({syntheticRecording(rig)}, compensation::Scheme::kPerCurvature);
  for (const ConditionScore& condition : calibration.scores.conditions) {
    EXPECT_GT(condition.score.within_one_deviation, 0.63);
    EXPECT_LT(condition.score.within_one_deviation, 0.73);
  }
}

TEST(Calibrate, FlatOnlyIsTrainedOnTheFlatSurfaceOnly) {
  const dataset::Recording recording = syntheticRecording(threeSurfaces());
  const Calibration flat = train({recording}, compensation::Scheme::kFlatOnly);
  const Calibration each = train({recording}, compensation::Scheme::kPerCurvature);
  ASSERT_EQ(flat.tables.classes.size(), 1u);
  EXPECT_EQ(flat.tables.classes[0].surface, "flat");
  EXPECT_EQ(flat.tables.table(4, 0).pressure, each.tables.table(4, 0).pressure);
  EXPECT_EQ(flat.tables.curvature_high, 0.0);
  EXPECT_EQ(each.tables.curvature_high, 20.0);
  ASSERT_EQ(flat.scores.conditions.size(), 3u);
  EXPECT_TRUE(flat.scores.conditions[0].trained);
  EXPECT_FALSE(flat.scores.conditions[2].trained);
  EXPECT_EQ(flat.statistics->classes.size(), 3u);  // the file contains the classes of all bags
}

TEST(Calibrate, WithoutScoresTheTablesAreTheSame) {
  CalibrationProblem problem{{syntheticRecording(threeSurfaces())}, {}};
  const Calibration scored = calibrate(problem);
  problem.options.scores = false;
  const Calibration bare = calibrate(problem);
  expectSameTables(scored, bare);
  EXPECT_TRUE(bare.scores.conditions.empty());
}

Calibration trainWith(const regression::RegressorOptions& regressor, bool choose_bandwidth = false) {
  CalibrationProblem problem{{syntheticRecording(threeSurfaces())}, {}};
  problem.options.regressor = regressor;
  problem.options.choose_bandwidth = choose_bandwidth;
  return calibrate(problem);
}

TEST(Calibrate, EveryRegressorRecoversTheCurves) {
  for (const std::string& name : regression::regressorNames()) {
    regression::RegressorOptions regressor;
    regressor.name = name;
    const Calibration calibration = trainWith(regressor);
    EXPECT_EQ(calibration.regressor.name, name);
    const double bound = name == "linear" ? 0.15 : 0.02;  // the curve is a square root
    EXPECT_LT(calibration.scores.whole.errors.whole.all.rmse, bound * 600e3) << name;
    for (const regression::CodeTable& table : calibration.tables.tables) {
      for (const float deviation : table.deviation) ASSERT_GT(deviation, 0.0f) << name;
    }
  }
}

TEST(Calibrate, AChosenBandwidthIsBetterThanThePapersOnHeldOutReadings) {
  const Calibration chosen = trainWith({}, true);
  const Calibration paper = trainWith({}, false);
  EXPECT_TRUE(chosen.bandwidth_chosen);
  EXPECT_FALSE(paper.bandwidth_chosen);
  EXPECT_EQ(paper.regressor.grnn.bandwidth, regression::kPaperBandwidth);
  EXPECT_NE(chosen.regressor.grnn.bandwidth, regression::kPaperBandwidth);
  EXPECT_LT(chosen.scores.whole.rmse_percent.mean, paper.scores.whole.rmse_percent.mean);
}

TEST(Calibrate, TheSeedIsUsedForTheForest) {
  CalibrationProblem problem{{plainRecording()}, {}};
  problem.options.regressor.name = "forest";
  const Calibration one = calibrate(problem);
  expectSameTables(one, calibrate(problem));
  problem.options.seed = 2;
  EXPECT_NE(one.tables.tables[0].pressure, calibrate(problem).tables.tables[0].pressure);
}

TEST(Calibrate, StoresItsProvenance) {
  SyntheticRig rig = threeSurfaces();
  dataset::Recording recording = syntheticRecording(rig);
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    recording.temperature.push_back(20.0 + 1e-3 * static_cast<double>(i));
  }
  recording.warnings.push_back("something to know");
  const Calibration calibration = train({recording}, compensation::Scheme::kPerCurvature);
  EXPECT_EQ(calibration.provenance.date, "2024-05-06T07:08:09Z");
  EXPECT_EQ(calibration.provenance.bags.at(0).name, "synthetic.bag");
  EXPECT_EQ(calibration.provenance.bags[0].scans, 3000u);
  EXPECT_EQ(calibration.sensor.serial, "0001");
  EXPECT_EQ(calibration.trained.pressure.high, 600e3);
  EXPECT_NEAR(calibration.trained.pressure_rate.high, 120e3, 1.0);  // 600 kPa in 5 s
  EXPECT_NEAR(calibration.trained.pressure_rate.low, -120e3, 1.0);
  EXPECT_NEAR(calibration.trained.temperature.high, 22.999, 1e-9);
  EXPECT_EQ(calibration.coverage.conditions.size(), 3u);
  EXPECT_EQ(calibration.warnings, std::vector<std::string>{"synthetic.bag: something to know"});
}

TEST(Calibrate, NamesTheWorstTaxel) {
  dataset::Recording recording = syntheticRecording(threeSurfaces());
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    recording.counts[6 * i + 2] = static_cast<std::uint16_t>(recording.counts[6 * i + 2] + 97 * i % 200);
  }
  const Score score = train({recording}, compensation::Scheme::kPerCurvature).scores.conditions.at(1).score;
  EXPECT_EQ(score.worst_taxel, 2u);
  EXPECT_GT(score.worst_rmse_percent, 2 * score.rmse_percent.mean);
}

void holdConstant(dataset::Recording& recording, std::size_t taxel) {
  const std::size_t taxels = recording.layout.size.taxels();
  for (std::size_t i = 0; i < recording.scans(); ++i) recording.counts[i * taxels + taxel] = 7;
}

TEST(Calibrate, AConstantTaxelGetsNoModelAndAWarning) {
  dataset::Recording recording = syntheticRecording(threeSurfaces());
  recording.mask = {0, 1, 0, 0, 0, 0};
  holdConstant(recording, 3);
  const Calibration calibration = train({recording}, compensation::Scheme::kPerCurvature);
  EXPECT_EQ(calibration.no_model, (std::vector<std::uint8_t>{0, 1, 0, 1, 0, 0}));
  EXPECT_TRUE(std::isnan(calibration.tables.table(1, 0).pressure[100]));
  EXPECT_TRUE(std::isnan(calibration.tables.table(3, 2).deviation[100]));
  EXPECT_TRUE(test_support::holds(calibration.warnings.back(), {"get no model: 3"}));
  EXPECT_EQ(calibration.scores.whole.readings, 3000u * 4);
}

TEST(Calibrate, ShortRecordingsAreCalibratedWithAWarning) {
  SyntheticRig rig;
  rig.cycles = 1;
  rig.scans_per_cycle = 3;
  const Calibration calibration = train({syntheticRecording(rig)}, compensation::Scheme::kPerCurvature);
  for (const float pressure : calibration.tables.table(0, 0).pressure) EXPECT_TRUE(std::isfinite(pressure));
  for (const float deviation : calibration.tables.table(0, 0).deviation) EXPECT_GT(deviation, 0.0f);
  EXPECT_EQ(calibration.warnings.size(), 1u);
}

TEST(Calibrate, ScansWithoutAPressureAreNotUsed) {
  const dataset::Recording whole = syntheticRecording(threeSurfaces());
  dataset::Recording holed = whole;
  holed.pressure[1] = std::nan("");
  const Calibration calibration = train({holed}, compensation::Scheme::kPerCurvature);
  EXPECT_EQ(calibration.scores.whole.readings, 2999u * 6);
  EXPECT_EQ(calibration.trained.pressure.high, 600e3);
}

TEST(Calibrate, ReportsItsProgress) {
  std::vector<std::pair<std::string, double>> told;
  calibrate({{plainRecording()}, {}},
            [&](const std::string& step, double share) { told.emplace_back(step, share); });
  const std::vector<std::pair<std::string, double>> expected = {{"choosing the bandwidth", 0},
                                                                {"choosing the bandwidth", 1},
                                                                {"training the taxels", 0},
                                                                {"training the taxels", 1},
                                                                {"history", 0}};
  EXPECT_EQ(told, expected);
}

std::string complaint(const CalibrationProblem& problem) {
  return test_support::refusal([&] { calibrate(problem); }, "accepted");
}

TEST(Calibrate, UnusableRecordingsAreRefusedInOneSentence) {
  const dataset::Recording good = syntheticRecording({});
  dataset::Recording bad = good;
  bad.name = "bad.bag";
  const auto refusal = [&](dataset::Recording recording) { return complaint({{good, recording}, {}}); };

  EXPECT_TRUE(test_support::holds(complaint({{}, {}}), {"there is no recording to train on"}));
  dataset::Recording other = bad;
  other.pressure.clear();
  EXPECT_TRUE(test_support::holds(refusal(other), {"bad.bag", "chamber_pressure"}));
  other = bad;
  other.conditions[0].curvature.clear();
  EXPECT_TRUE(test_support::holds(refusal(other), {"bad.bag", "no curvature is recorded"}));
  SyntheticRig wide;
  wide.name = "wide.bag";
  wide.size = {3, 3};
  EXPECT_TRUE(test_support::holds(refusal(syntheticRecording(wide)),
                                  {"wide.bag", "matrix is 3 x 3", "synthetic.bag", "2 x 3"}));
  other = bad;
  other.full_scale = 1023;
  EXPECT_TRUE(
      test_support::holds(refusal(other), {"bad.bag", "full_scale", "1023", "synthetic.bag", "4095"}));
  other = bad;
  other.sensor.serial = "0002";
  EXPECT_TRUE(
      test_support::holds(refusal(other), {"bad.bag", "number is \"0002\"", "synthetic.bag", "\"0001\""}));
  other = bad;
  std::fill(other.pressure.begin(), other.pressure.end(), 3e3);
  EXPECT_TRUE(
      test_support::holds(complaint({{other}, {}}), {"bad.bag", "the chamber pressure never changes"}));
  other = bad;
  std::fill(other.pressure.begin(), other.pressure.end(), std::nan(""));
  EXPECT_EQ(refusal(other), "bad.bag: no scan on \"flat\" has a chamber pressure");
  other = bad;
  other.pressure[7] = 1e9;
  EXPECT_TRUE(
      test_support::holds(refusal(other), {"bad.bag", "pressure is 1000000000.000000 Pa", "+-8000000 Pa"}));
  EXPECT_TRUE(
      test_support::holds(refusal(bad), {"bad.bag", "synthetic.bag", "has the same bytes as synthetic.bag"}));
  other = dataset::Recording{};
  other.name = "bad.bag";
  other.losses.near_change = 12;
  EXPECT_TRUE(test_support::holds(refusal(other), {"bad.bag: no scan is left", "12", "change of surface"}));
  dataset::Recording one = good, half = good;
  one.sensor.model = "65535 counts = 0.2 S";
  half.sensor.model = "65535 counts = 0.1 S";
  half.name = "bad.bag";
  half.sha256 = "";
  EXPECT_TRUE(test_support::holds(complaint({{one, half}, {}}),
                                  {"bad.bag", "readings is \"65535 counts = 0.1 S\"", good.name,
                                   "is \"65535 counts = 0.2 S\"", "--range"}));
}

TEST(Calibrate, OptionsOutOfRangeAreRefused) {
  CalibrationProblem problem{{syntheticRecording({})}, {}};
  problem.options.folds = 1;
  EXPECT_TRUE(test_support::holds(complaint(problem), {"folds is 1", "2 to 20"}));
  problem.options.folds = 5;
  problem.options.regressor.grnn.bandwidth = 0;
  EXPECT_TRUE(test_support::holds(complaint(problem), {"bandwidth is 0", "1e-06 to 1000"}));
}

TEST(Calibrate, AMatrixWithoutReadingsIsRefused) {
  dataset::Recording recording = syntheticRecording({});
  for (std::size_t taxel = 0; taxel < 6; ++taxel) holdConstant(recording, taxel);
  EXPECT_TRUE(
      test_support::holds(complaint({{recording}, {}}),
                          {"synthetic.bag", "every taxel is masked or reads the same count throughout"}));
}

}  // namespace
}  // namespace fsr::calibration
