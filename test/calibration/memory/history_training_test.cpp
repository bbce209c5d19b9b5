// Training with a model of the sheet's memory: what is chosen, what it is worth on other protocols through
// the live path, and what files and merging do with it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>

#include "calibration/merge.h"
#include "calibration/stages/memory/history_folds.h"
#include "calibration/stages/memory/history_stream.h"
#include "calibration/stages/memory/history_training.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/file_complaint.h"
#include "support/live_rmse.h"
#include "support/memory_rig.h"

namespace fsr::calibration {
namespace {

using test_support::MemoryRig;

MemoryRig rigWith(double loop, double creep) {
  MemoryRig rig;
  rig.program = test_support::variedProgram();
  rig.loop = loop;
  rig.creep = creep;
  return rig;
}

Calibration trained(const MemoryRig& rig, const HistoryChoice& choice = {}) {
  CalibrationProblem problem{{test_support::memoryRecording(rig)}, {}};
  problem.options.date = "2026-11-22T12:00:00Z";
  problem.options.history = choice;
  return calibrate(problem);
}

// A protocol that training has not seen: slower, another peak, staircase-like dwells.
dataset::Recording another(MemoryRig rig) {
  rig.program = {{3, 500e3, 35e3, 8, 6}, {2, 600e3, 12e3, 4, 4}};
  rig.seed = 2;
  return test_support::memoryRecording(rig);
}

double errorOn(const Calibration& calibration, const dataset::Recording& recording) {
  return test_support::liveRmse(calibration, {recording});
}

// The states of the operators on 3 taxels with one table, at each scan of bags cut from one recording.
std::vector<double> statesOf(const std::vector<dataset::Recording>& bags) {
  std::vector<dataset::Sections> sections;
  for (const dataset::Recording& bag : bags) sections.push_back(dataset::divideIntoSections(bag, 5));
  const dataset::Protocols protocols = dataset::protocolsOf(bags, sections);
  const HistoryGrid grid{{0, 600e3}, {30e3, 90e3}, {1, 10}};
  StaticAnswer answer;
  for (int code = 0; code < 4096; ++code) answer.pressure.push_back(170.0 * code);
  std::vector<double> states;
  HistoryCourse course;
  for (const HistoryStream& stream : historyStreams(
           bags, std::vector<std::vector<std::size_t>>(bags.size(), {0}), sections, protocols, grid))
    stream.run(1, {answer}, course, [&](const auto&, double, const double* state, const double*) {
      states.insert(states.end(), state, state + 4);
    });
  return states;
}

// "The second bag begins in the middle of the first one's creep."
TEST(HistoryStream, GoesOnInTheNextBagOfASheetThatLayOn) {
  const dataset::Recording whole = test_support::memoryRecording(rigWith(0.08, 0.06));
  const dataset::Recording first = test_support::partOf(whole, 0, 260);
  dataset::Recording second = test_support::partOf(whole, 260, whole.scans());
  const std::vector<double> undivided = statesOf({whole});
  const std::vector<double> cut = statesOf({second, first});
  ASSERT_EQ(cut.size(), undivided.size());
  for (std::size_t k = 0; k < cut.size(); ++k) ASSERT_NEAR(cut[k], undivided[k], 1e-3) << k / 4;
  second.start_ns += 7'200'000'000'000;  // two hours later
  EXPECT_GT(std::abs(statesOf({first, second})[4 * 300 + 3] - undivided[4 * 300 + 3]), 1e3);
}

TEST(HistoryTraining, TakesOutALoopOfAnotherFormulaOnAnotherProtocol) {
  const MemoryRig rig = rigWith(0.08, 0);
  const Calibration with = trained(rig), without = trained(rig, {false, HistoryFamily::kNone});
  EXPECT_TRUE(with.history.family == HistoryFamily::kPlays || with.history.family == HistoryFamily::kBoth);
  EXPECT_FALSE(without.history.present());
  EXPECT_LT(errorOn(with, another(rig)), 0.5 * errorOn(without, another(rig)));
  ASSERT_EQ(with.scores.history.protocols.size(), 4u);
  for (const auto& protocol : with.scores.history.protocols)
    EXPECT_LT(protocol.rmse[std::size_t(with.history.family)], 0.5 * protocol.rmse[0]) << protocol.name;
}

TEST(HistoryTraining, TakesOutPartOfACreepOfAnotherFormula) {
  const MemoryRig rig = rigWith(0, 0.06);
  const Calibration with = trained(rig), without = trained(rig, {false, HistoryFamily::kNone});
  ASSERT_TRUE(with.history.present());
  EXPECT_LT(errorOn(with, another(rig)), 0.9 * errorOn(without, another(rig)));
}

TEST(HistoryTraining, ChoosesNoneWhereNothingIsHidden) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    MemoryRig rig = rigWith(0, 0);
    rig.seed = seed;
    const Calibration calibration = trained(rig);
    EXPECT_FALSE(calibration.history.present()) << calibration.scores.history.choice;
    EXPECT_NE(calibration.scores.history.choice.find("none"), std::string::npos);
  }
}

// Everything that existed keeps its numbers.
TEST(HistoryTraining, ChangesNoTable) {
  const MemoryRig rig = rigWith(0.08, 0);
  const Calibration with = trained(rig), without = trained(rig, {false, HistoryFamily::kNone});
  ASSERT_EQ(with.tables.tables.size(), without.tables.tables.size());
  for (std::size_t i = 0; i < with.tables.tables.size(); ++i) {
    EXPECT_EQ(with.tables.tables[i].pressure, without.tables.tables[i].pressure);
    EXPECT_EQ(with.tables.tables[i].deviation, without.tables.tables[i].deviation);
  }
}

// In the mean over sheets: a bin's quantile is that of the mean protocol, not of the readings.
TEST(HistoryTraining, StatesADeviationThatHoldsInBothDirections) {
  std::array<double, 3> within = {};
  constexpr unsigned kSheets = 4;
  for (unsigned seed = 1; seed <= kSheets; ++seed) {
    MemoryRig rig = rigWith(0.08, 0.02);
    rig.seed = seed;
    const Calibration calibration = trained(rig);
    ASSERT_GE(calibration.scores.history.parts.size(), within.size());
    for (std::size_t part = 0; part < within.size(); ++part)
      within[part] += calibration.scores.history.parts[part].within_one_deviation / kSheets;
  }
  for (std::size_t part = 0; part < within.size(); ++part) EXPECT_NEAR(within[part], 0.683, 0.06) << part;
}

// By readings, the long protocol with small errors would leave 50 % in the mean.
TEST(HistoryErrors, CoverTheMeanProtocolHoweverLongEachIs) {
  HistoryErrors errors(600e3, 1e3, 2);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const std::vector<double> scatter = {1e3, 4e3};  // [Pa]
  for (std::size_t i = 0; i < 20000; ++i) {
    HistoryErrors::Reading reading;
    reading.protocol = i % 10 == 0;
    reading.answer = 300e3;
    reading.truth = reading.answer + scatter[reading.protocol] * normal(random);
    errors.add(reading);
  }
  HistoryModel model;
  errors.setDeviation(model);
  double within = 0;
  for (const double own : scatter) within += std::erf(model.loading_deviation[6] / own / std::sqrt(2.0)) / 2;
  EXPECT_NEAR(within, 0.683, 0.03);
}

TEST(HistoryTraining, NeedsTwoProtocols) {
  MemoryRig rig = rigWith(0.08, 0);
  rig.program = {{8, 600e3, 20e3, 2, 2}};
  const Calibration automatic = trained(rig);
  EXPECT_FALSE(automatic.history.present());
  EXPECT_NE(automatic.scores.history.choice.find("two paces"), std::string::npos);
  EXPECT_THROW(trained(rig, {false, HistoryFamily::kPlays}), settings::InputError);
}

TEST(HistoryTraining, NeedsTwoProtocolsOnOneSurface) {
  MemoryRig slow = rigWith(0.08, 0), fast = slow;
  slow.program = {{6, 600e3, 20e3, 2, 2}};
  fast.program = {{6, 600e3, 60e3, 2, 2}};
  CalibrationProblem problem{{test_support::memoryRecording(slow), test_support::memoryRecording(fast)}, {}};
  problem.recordings[1].conditions = {{"cylinder_5cm", 1, {{20, 0, 0}}, {}}};
  const Calibration calibration = calibrate(problem);
  EXPECT_FALSE(calibration.history.present());
  EXPECT_EQ(calibration.scores.history.choice.find("History: none, since no surface was recorded with two"),
            0u)
      << calibration.scores.history.choice;
}

TEST(HistoryTraining, GivesTheSameOnAnyNumberOfThreads) {
  CalibrationProblem problem{{test_support::memoryRecording(rigWith(0.08, 0.02))}, {}};
  problem.options.threads = 1;
  const Calibration one = calibrate(problem);
  problem.options.threads = 3;
  const Calibration three = calibrate(problem);
  EXPECT_EQ(one.history.play_weight, three.history.play_weight);
  EXPECT_EQ(one.history.correction, three.history.correction);
  EXPECT_EQ(one.history.loading_deviation, three.history.loading_deviation);
}

class HistoryFile : public testing::Test {
 protected:
  ~HistoryFile() override { std::remove(path_.c_str()); }
  std::string firstLine() const {
    std::string line;
    std::ifstream file(path_, std::ios::binary);
    std::getline(file, line);
    return line;
  }
  const std::string path_ = testing::TempDir() + "history_" + std::to_string(::getpid()) + ".h5";
};

TEST_F(HistoryFile, KeepsTheModelAndItsScores) {
  Calibration calibration = trained(rigWith(0.08, 0.02), {false, HistoryFamily::kBoth});
  saveCalibration(calibration, path_);
  EXPECT_NE(firstLine().find("schema=3"), std::string::npos) << firstLine();
  const Calibration loaded = loadCalibration(path_, CalibrationParts::kAll);
  EXPECT_EQ(loaded.history.family, HistoryFamily::kBoth);
  EXPECT_EQ(loaded.history.radius, calibration.history.radius);
  EXPECT_EQ(loaded.history.memory_weight, calibration.history.memory_weight);
  EXPECT_FALSE(loaded.history.memory_spread.empty());
  EXPECT_EQ(loaded.history.memory_spread, calibration.history.memory_spread);
  EXPECT_EQ(loaded.history.least_change.size(), 17u);
  EXPECT_EQ(loaded.history.least_change, calibration.history.least_change);
  EXPECT_EQ(loaded.history.largest_change, calibration.history.largest_change);
  EXPECT_EQ(loaded.history.unloading_deviation, calibration.history.unloading_deviation);
  EXPECT_EQ(loaded.scores.history.choice, calibration.scores.history.choice);
  ASSERT_EQ(loaded.scores.history.parts.size(), calibration.scores.history.parts.size());
  EXPECT_EQ(loaded.scores.history.parts.back().rmse, calibration.scores.history.parts.back().rmse);
  EXPECT_EQ(loaded.scores.history.protocols.back().rmse, calibration.scores.history.protocols.back().rmse);
}

// An older version reads files without a model.
TEST_F(HistoryFile, HasTheOldSchemaWithoutAModel) {
  saveCalibration(trained(rigWith(0, 0)), path_);
  EXPECT_NE(firstLine().find("schema=2"), std::string::npos) << firstLine();
}

TEST_F(HistoryFile, CannotBeMerged) {
  const Calibration calibration = trained(rigWith(0.08, 0));
  try {
    mergeCalibrations({{"a.h5", calibration}, {"b.h5", calibration}}, {});
    FAIL();
  } catch (const settings::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a.h5: has a model of the sheet's memory"), std::string::npos);
  }
}

TEST_F(HistoryFile, IsRefusedWhereItsModelCannotBeUsed) {
  const Calibration whole = trained(rigWith(0.08, 0));
  const auto complaint = [&](const std::function<void(Calibration&)>& spoil) {
    return test_support::fileComplaint(whole, path_, spoil);
  };
  EXPECT_EQ(complaint([](Calibration&) {}), "accepted");
  EXPECT_NE(complaint([](Calibration& c) { c.history.radius.front() = -1; }).find("/history/radius"),
            std::string::npos);
  EXPECT_NE(complaint([](Calibration& c) { c.history.play_weight.pop_back(); }).find("/history/play_weight"),
            std::string::npos);
  EXPECT_NE(complaint([](Calibration& c) { c.history.knot.back() *= 2; }).find("evenly"), std::string::npos);
  EXPECT_NE(complaint([](Calibration& c) {
              c.history.correction[1] = NAN;
            }).find("/history/correction has a value of .nan"),
            std::string::npos);
}

// The play and the memory of these samples follow the same slow course, each with noise of its own. The
// target is `noise` times the difference of the two, and `loop` times the play's.
LeftOutSums sumsOf(const HistoryGrid& grid, double noise, double loop) {
  LeftOutSums sums(grid.features());
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1e3);
  std::vector<double> features(grid.features());
  for (int i = 0; i < 20000; ++i) {
    const double x = 600e3 * (i % 100) / 100, course = 20 * normal(random);
    std::vector<double> state(grid.radii.size() + grid.time_constants.size(), x);
    double& play = state[1];
    double& memory = state[grid.radii.size()];
    play += course + normal(random);
    memory += course + normal(random);
    historyFeatures(grid, x, state.data(), features.data());
    const double target = noise * (play - memory) + loop * (play - x) + 0.5 * normal(random);
    (i % 2 == 0 ? sums.trained : sums.part(std::size_t(i / 2 % 12))).add(features.data(), target);
  }
  sums.finish();
  return sums;
}

// A protocol of six cycles. The weight of the play is 0.2 where it was trained and in the first `alike`
// parts, halves of the cycles, and 0 in the others.
LeftOutSums partsOf(const HistoryGrid& grid, int alike) {
  LeftOutSums sums(grid.features());
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 1e3);
  std::vector<double> features(grid.features());
  for (int i = 0; i < 20000; ++i) {
    const double x = 600e3 * (i % 100) / 100;
    std::vector<double> state(grid.radii.size() + grid.time_constants.size(), x);
    state[1] += 20 * normal(random);
    historyFeatures(grid, x, state.data(), features.data());
    const int part = i / 2 % 12;
    const double loop = i % 2 == 0 || part < alike ? 0.2 : 0;
    const double target = loop * (state[1] - x) + 0.5 * normal(random);
    (i % 2 == 0 ? sums.trained : sums.part(std::size_t(part))).add(features.data(), target);
  }
  sums.finish();
  return sums;
}

TEST(HistoryChoiceRule, CountsWhatIsBeyondChance) {
  const HistoryGrid grid = historyGrid(0, 600e3, 30);
  const auto chosen = [&](int first, int second, int third) {
    return chooseHistory({}, grid, {"a", "b", "c"},
                         {partsOf(grid, first), partsOf(grid, second), partsOf(grid, third)});
  };
  EXPECT_EQ(chosen(12, 12, 12).family, HistoryFamily::kPlays);
  EXPECT_EQ(chosen(7, 7, 7).family, HistoryFamily::kNone) << "better by more than 2 %, by chance";
  const HistoryVerdict some = chosen(12, 12, 5);
  const auto& rmse = some.score.protocols[2].rmse;
  EXPECT_GT(rmse[std::size_t(HistoryFamily::kPlays)], 1.01 * rmse[0]);
  EXPECT_EQ(some.family, HistoryFamily::kPlays) << "worse on a protocol, but not beyond chance";
  EXPECT_EQ(chosen(12, 12, 0).family, HistoryFamily::kNone) << "worse beyond chance on a protocol";
  EXPECT_NE(some.score.choice.find("(95 %: "), std::string::npos) << some.score.choice;
}

TEST(HistoryChoiceRule, PlaysAndMemoriesOfUseOnlyTogetherAreNone) {
  const HistoryGrid grid = historyGrid(0, 600e3, 30);
  const std::vector<std::string> names = {"one", "other"};
  const auto chosen = [&](double noise, double loop) {
    return chooseHistory({}, grid, names, {sumsOf(grid, noise, loop), sumsOf(grid, noise, loop)});
  };
  const HistoryVerdict filter = chosen(0.8, 0);
  EXPECT_EQ(filter.family, HistoryFamily::kNone);
  ASSERT_EQ(filter.score.protocols.size(), 2u);
  const auto& rmse = filter.score.protocols[0].rmse;
  EXPECT_LT(rmse[std::size_t(HistoryFamily::kBoth)], 0.8 * rmse[0]) << "it would have won";
  EXPECT_EQ(chosen(0, 0.2).family, HistoryFamily::kPlays);
  EXPECT_EQ(chosen(0.8, 0.2).family, HistoryFamily::kBoth);
}

TEST(HistoryChoiceRule, AsksTheMeansWhetherThereIsAMemory) {
  const HistoryGrid grid = historyGrid(0, 600e3, 30);
  const std::vector<LeftOutSums> loop = {sumsOf(grid, 0, 0.2), sumsOf(grid, 0, 0.2)};
  const std::vector<LeftOutSums> nothing = {sumsOf(grid, 0, 0), sumsOf(grid, 0, 0)};
  EXPECT_EQ(chooseHistory({}, grid, {"one", "other"}, loop, loop).family, HistoryFamily::kPlays);
  EXPECT_EQ(chooseHistory({}, grid, {"one", "other"}, loop, nothing).family, HistoryFamily::kNone)
      << "what readings gain is the filtering of their noise";
  EXPECT_EQ(chooseHistory({}, grid, {"one", "other"}, nothing, loop).family, HistoryFamily::kNone)
      << "it does not help on other protocols";
}

// Of a live map: the flag, what starts the memory anew, and what does not.
class LiveHistory : public testing::Test {
 protected:
  static Calibration calibration() {
    static const Calibration result = trained(rigWith(0.08, 0));
    return result;
  }
  std::uint16_t flags(double time, std::uint16_t code) {
    const std::vector<std::uint16_t> counts(3, code);
    calibrator_.calibrate({{1, 3}, 4095, counts.data(), 3}, time, map_);
    return map_.flags[1] & map::taxel_flag::kHistoryShort;
  }
  void settle(double from) {
    for (int i = 0; i <= 400; ++i) flags(from + 0.1 * i, std::uint16_t(200 + 15 * std::min(i, 400 - i)));
  }

  Calibrator calibrator_{calibration()};
  map::PressureMap map_;
};

TEST_F(LiveHistory, IsShortAtFirstAndThenNot) {
  EXPECT_NE(flags(0, 200), 0);
  settle(0.1);
  EXPECT_EQ(flags(41, 200), 0);
}

TEST_F(LiveHistory, IsShortAfterTimeRanBackAndAfterAnotherTare) {
  settle(0);
  EXPECT_NE(flags(10, 200), 0) << "a looped bag";
  settle(10);
  EXPECT_EQ(flags(51, 200), 0);
  calibrator_.setTare({100, 100, 100});
  EXPECT_NE(flags(52, 200), 0);
  calibrator_.setTare({100, 100, 100});
  calibrator_.markRest();
  EXPECT_EQ(flags(53, 200), 0) << "a tare is measured at rest";
}

TEST_F(LiveHistory, SurvivesTheSameSurfaceAgain) {
  const matrix::Surface flat{"flat", 1, {{0, 0, 0}}, {}};
  calibrator_.setSurface(flat, 0);
  settle(0);
  calibrator_.setSurface(flat, 41);
  EXPECT_EQ(flags(41, 200), 0);
}

// The model's deviation was measured on surfaces that were known.
TEST(LiveHistoryOnTwoSurfaces, AnUncertainCurvatureIsPartOfTheDeviation) {
  Calibration two = trained(rigWith(0.08, 0));
  ASSERT_EQ(two.tables.classes.size(), 1u);
  two.tables.classes.push_back({"bent", {10.0}});
  two.tables.curvature_high = 10;
  std::vector<regression::CodeTable> tables;
  for (const regression::CodeTable& flat : two.tables.tables) {
    tables.push_back(flat);
    tables.push_back(flat);
    for (float& pressure : tables.back().pressure) pressure += 20e3f;
  }
  two.tables.tables = tables;
  const auto deviation = [&](double curvature_deviation) {
    Calibrator calibrator(two);
    calibrator.setSurface({"flat", 1, {{0, 0, 0}}, {curvature_deviation}}, 0);
    map::PressureMap map;
    for (int i = 0; i <= 400; ++i) {
      const std::vector<std::uint16_t> counts(3, std::uint16_t(200 + 15 * std::min(i, 400 - i)));
      calibrator.calibrate({{1, 3}, 4095, counts.data(), 3}, 0.1 * i, map);
    }
    EXPECT_EQ(map.flags[1] & map::taxel_flag::kHistoryShort, 0);
    return map.deviation[1];
  };
  EXPECT_NEAR(deviation(3), std::hypot(deviation(0), 3 * 2e3), 1);
}

TEST_F(LiveHistory, IsShortWhileSaturated) {
  settle(0);
  EXPECT_NE(flags(41, 4095), 0);
  EXPECT_EQ(flags(42, 200), 0);
}

}  // namespace
}  // namespace fsr::calibration
