// Training with a thermometer: the sensitivity to temperature that a simulated rig hides is found with its
// lag, and nothing where nothing is hidden.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <tuple>

#include "calibration/merge.h"
#include "calibration/same_tables.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/simulate.h"
#include "simulation/settings_text.h"
#include "support/file_complaint.h"
#include "support/holds.h"
#include "support/live_rmse.h"
#include "support/simulated_rig.h"

namespace fsr::calibration {
namespace {

using Recordings = std::vector<dataset::Recording>;

// A straight sensor, three taxels. Its readings are those of the simulator; the chamber runs two paces,
// dwells and peaks in each of the bags.
struct WarmRig {
  std::string room =
      "[{time: 0, temperature: 21}, {time: 130, temperature: 21}, {time: 190, temperature: 28}, "
      "{time: 800, temperature: 28}, {time: 860, temperature: 22}, {time: 1450, temperature: 22}, "
      "{time: 1500, temperature: 26}]";
  double heating = 0;  // [K/Pa]
  std::string effects;
  unsigned seed = 1;
  int bags = 3;
  bool one_protocol = false;
  bool bent = false;  // each bag on another surface
};

Recordings recordingsOf(const WarmRig& rig) {
  std::string session;
  for (int k = 0; k < rig.bags; ++k)
    session += std::string(k == 0 ? "" : ", ") +
               (rig.bent ? "{surface: c" + std::to_string(k) + ", cylinder: {radius: 0.0" +
                               std::to_string(5 + 2 * k) + ", axis: y}}"
                         : "{surface: flat, flat: true}");
  const std::string one =
      "  - cycles: {peak: 600000, rate: 30000, dwell_peak: 8, dwell_rest: 8, cycles: 9}\n";
  const std::string varied =
      "  - cycles: {peak: 600000, rate: 20000, cycles: 3}\n"
      "  - cycles: {peak: 600000, rate: 60000, dwell_peak: 20, dwell_rest: 20, cycles: 3}\n"
      "  - cycles: {peak: 350000, rate: 60000, dwell_rest: 5, cycles: 3}\n"
      "  - cycles: {peak: 600000, rate: 20000, dwell_peak: 20, dwell_rest: 10, cycles: 2}\n";
  const std::string text = "simulation: warm\nseed: " + std::to_string(rig.seed) +
                           "\nmatrix: {rows: 1, columns: 3}\nboard: {scan_rate: 4}\nprogram:\n" +
                           (rig.one_protocol ? one : varied) + "session: [" + session +
                           "]\nclimate: {room: " + rig.room +
                           ", heating: " + std::to_string(rig.heating * 1e6) +
                           "e-6, cooling: 20}\neffects:\n"
                           "  static_curve: {conductance_scatter: 0, exponent: 1, saturation_pressure: .inf, "
                           "conductance: 2.5e-4}\n"
                           "  bending_preload: {amplitude: 20000, curvature_constant: 3}\n"
                           "  white_noise: {absolute: 3, relative: 0.001}\n"
                           "  converter: {full_scale: 4095, feedback_resistance: 3600}\n" +
                           rig.effects;
  return simulation::simulateSession(
      simulation::readSimulation(settings::Settings::fromText(text, "warm.yaml")));
}

WarmRig warmRig(double coefficient = 0.0036, double lag = 120) {
  WarmRig rig;
  rig.effects =
      "  temperature: {coefficient: " + std::to_string(coefficient) + ", lag: " + std::to_string(lag) + "}\n";
  return rig;
}

Calibration warmTrained(const Recordings& recordings, const HistoryChoice& choice = {},
                        bool temperature = true) {
  CalibrationProblem problem{recordings, {}};
  problem.options.date = "2026-11-22T12:00:00Z";
  problem.options.history = choice;
  problem.options.temperature = temperature;
  return calibrate(problem);
}

// The room of another day.
Recordings another(WarmRig rig) {
  rig.room = "[{time: 0, temperature: 28}, {time: 300, temperature: 28}, {time: 360, temperature: 22}]";
  rig.bags = 1;
  rig.seed += 100;
  return recordingsOf(rig);
}

double errorOn(const Calibration& calibration, const Recordings& recordings) {
  return test_support::liveRmse(calibration, recordings);
}

// s = -0.0036 / K of the conductance at 23 degree Celsius is -0.35 % a kelvin of the pressure at the 25 of
// the bags.
TEST(TemperatureTraining, FindsSensitivityAndLagOfTheRig) {
  for (const double lag : {1.0, 30.0, 120.0}) {
    const WarmRig rig = warmRig(0.0036, lag);
    const Recordings recordings = recordingsOf(rig);
    const Calibration with = warmTrained(recordings), without = warmTrained(recordings, {}, false);
    EXPECT_NEAR(with.temperature.sensitivity, -0.0035, 0.0002) << with.scores.temperature.choice;
    EXPECT_EQ(with.temperature.lag, lag == 1 ? 0 : lag);
    EXPECT_NEAR(with.temperature.low, 21, 0.1);
    EXPECT_NEAR(with.temperature.high, 28, 0.1);
    ASSERT_EQ(with.scores.temperature.groups.size(), 7u) << "four protocols and three recordings";
    for (const TemperatureScore::Group& group : with.scores.temperature.groups)
      EXPECT_LT(group.with, 0.8 * group.without) << group.name;
    EXPECT_LT(errorOn(with, another(rig)), 0.4 * errorOn(without, another(rig)));
  }
}

// Filling the chamber heats the gas by up to 6 K: what loop and creep do is not temperature.
TEST(TemperatureTraining, FindsTheSameInAChamberThatHeatsItsGas) {
  WarmRig rig = warmRig(-0.0036, 30);
  rig.heating = 1e-5;
  const Calibration calibration = warmTrained(recordingsOf(rig));
  EXPECT_NEAR(calibration.temperature.sensitivity, 0.0036, 0.0003) << calibration.scores.temperature.choice;
  EXPECT_EQ(calibration.temperature.lag, 30);
}

TEST(TemperatureTraining, ChoosesNoneWhereNothingIsHidden) {
  for (const char* effects : {"", "  hysteresis: {loop_width: 0.07}\n  creep: {per_decade: 0.035}\n",
                              "  drift: {rate_per_hour: 0.02}\n"}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      WarmRig rig;
      rig.effects = effects;
      rig.heating = 1e-5;
      rig.seed = seed;
      const Calibration calibration = warmTrained(recordingsOf(rig));
      EXPECT_FALSE(calibration.temperature.present()) << effects << calibration.scores.temperature.choice;
      EXPECT_EQ(calibration.scores.temperature.choice.find("Temperature: none, since "), 0u);
    }
  }
}

TEST(TemperatureTraining, SaysInOneLineThatTheTemperatureDidNotChange) {
  WarmRig rig = warmRig();
  rig.room = "23";
  rig.bags = 1;
  EXPECT_TRUE(test_support::holds(warmTrained(recordingsOf(rig)).scores.temperature.choice,
                                  {"Temperature: none", "differ by 0.5 K or less"}));
}

// Everything that existed keeps its numbers without a thermometer, and where no model is asked for or chosen.
TEST(TemperatureTraining, ChangesNothingWhereItIsNotChosen) {
  WarmRig rig = warmRig();
  rig.effects += "  hysteresis: {loop_width: 0.05}\n";
  const Recordings recordings = recordingsOf(rig);
  Recordings without = recordings;
  for (dataset::Recording& recording : without) recording.temperature.clear();
  const Calibration none = warmTrained(recordings, {}, false), bare = warmTrained(without);
  EXPECT_TRUE(none.history.present());
  EXPECT_TRUE(none.scores.temperature.choice.empty());
  EXPECT_TRUE(bare.scores.temperature.choice.empty());
  EXPECT_FALSE(bare.temperature.present());
  expectSameTables(none, bare);
  rig.room = "23";
  const Recordings constant = recordingsOf(rig);
  expectSameTables(warmTrained(constant), warmTrained(constant, {}, false));
}

TEST(TemperatureTraining, GivesTheSameOnAnyNumberOfThreads) {
  CalibrationProblem problem{recordingsOf(warmRig()), {}};
  problem.options.threads = 1;
  const Calibration one = calibrate(problem);
  problem.options.threads = 3;
  const Calibration three = calibrate(problem);
  EXPECT_TRUE(one.temperature.present());
  EXPECT_EQ(one.temperature.sensitivity, three.temperature.sensitivity);
  expectSameTables(one, three);
}

TEST(TemperatureTraining, DoesNotNeedASecondProtocolOrAHistory) {
  WarmRig rig = warmRig(0.0036, 30);
  const Calibration alone = warmTrained(recordingsOf(rig), {false, HistoryFamily::kNone});
  EXPECT_FALSE(alone.history.present());
  EXPECT_TRUE(alone.temperature.present());
  rig.one_protocol = true;
  const Calibration one = warmTrained(recordingsOf(rig));
  EXPECT_FALSE(one.history.present());
  EXPECT_NEAR(one.temperature.sensitivity, -0.0035, 0.0003) << one.scores.temperature.choice;
  EXPECT_EQ(one.scores.temperature.groups.size(), 3u);
}

TEST(TemperatureTraining, NeedsSomethingThatCanBeLeftOut) {
  WarmRig rig = warmRig();
  rig.one_protocol = true;
  rig.bags = 1;
  const Calibration calibration = warmTrained(recordingsOf(rig));
  EXPECT_FALSE(calibration.temperature.present());
  EXPECT_NE(calibration.scores.temperature.choice.find("no protocol and no recording can be left out"),
            std::string::npos)
      << calibration.scores.temperature.choice;
}

// Each bag is another surface: protocols alone can be left out.
TEST(TemperatureTraining, LeavesOutProtocolsWhereEachSurfaceHasOneBag) {
  WarmRig rig = warmRig(0.0036, 30);
  rig.bent = true;
  const Calibration calibration = warmTrained(recordingsOf(rig));
  EXPECT_NEAR(calibration.temperature.sensitivity, -0.0035, 0.0004) << calibration.scores.temperature.choice;
  EXPECT_EQ(calibration.scores.temperature.groups.size(), 4u);
}

class TemperatureFile : public testing::Test {
 protected:
  ~TemperatureFile() override { std::remove(path_.c_str()); }
  const std::string path_ = testing::TempDir() + "temperature_" + std::to_string(::getpid()) + ".h5";
};

TEST_F(TemperatureFile, KeepsTheModelAndItsScores) {
  const Calibration calibration = warmTrained(recordingsOf(warmRig()));
  saveCalibration(calibration, path_);
  const Calibration loaded = loadCalibration(path_, CalibrationParts::kAll);
  const TemperatureModel &own = calibration.temperature, &read = loaded.temperature;
  EXPECT_EQ(std::tie(own.sensitivity, own.reference, own.lag, own.low, own.high, own.spread),
            std::tie(read.sensitivity, read.reference, read.lag, read.low, read.high, read.spread));
  EXPECT_EQ(loaded.scores.temperature.choice, calibration.scores.temperature.choice);
  ASSERT_EQ(loaded.scores.temperature.groups.size(), calibration.scores.temperature.groups.size());
  EXPECT_EQ(loaded.scores.temperature.groups.back().name, "recording 3_flat.bag");
  EXPECT_EQ(loaded.scores.temperature.groups.back().with, calibration.scores.temperature.groups.back().with);
  try {
    mergeCalibrations({{"a.h5", loaded}, {"b.h5", loaded}}, {});
    FAIL();
  } catch (const settings::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a.h5: has a model of the temperature"), std::string::npos);
  }
}

// An older version would leave the model out in silence; without one it reads the file.
TEST_F(TemperatureFile, HasASchemaOfItsOwn) {
  const auto schema = [&](const Calibration& calibration) {
    saveCalibration(calibration, path_);
    std::string line;
    std::ifstream file(path_, std::ios::binary);
    std::getline(file, line);
    return line.substr(line.find("schema="), 8);
  };
  Calibration calibration = warmTrained(recordingsOf(warmRig()), {false, HistoryFamily::kNone});
  EXPECT_EQ(schema(calibration), "schema=3");
  calibration.temperature = {};
  EXPECT_EQ(schema(calibration), "schema=2");
}

TEST_F(TemperatureFile, IsRefusedWhereItsModelCannotBeUsed) {
  const Calibration whole = warmTrained(recordingsOf(warmRig()));
  const auto complaint = [&](const std::function<void(TemperatureModel&)>& spoil) {
    return test_support::fileComplaint(whole, path_, [&](Calibration& c) { spoil(c.temperature); });
  };
  EXPECT_EQ(complaint([](auto&) {}), "accepted");
  EXPECT_NE(
      complaint([](auto& model) { model.sensitivity = 7; }).find("/temperature/sensitivity has a value of 7"),
      std::string::npos);
  EXPECT_NE(complaint([](auto& model) { model.lag = NAN; }).find("/temperature/lag has a value of .nan"),
            std::string::npos);
  EXPECT_NE(complaint([](auto& model) { model.high = -20; }).find("/temperature/high has a value of -20"),
            std::string::npos);
}

// Of a live map.
class LiveTemperature : public testing::Test {
 protected:
  static const Calibration& calibration() {
    static const Calibration result =
        warmTrained(recordingsOf(warmRig(0.0036, 120)), {false, HistoryFamily::kNone});
    return result;
  }
  void map(double time, double temperature) {
    const std::vector<std::uint16_t> counts(3, 2000);
    calibrator_.setTemperature(temperature, calibration().trained.temperature.low,
                               calibration().trained.temperature.high);
    calibrator_.calibrate({{1, 3}, 4095, counts.data(), 3}, time, map_);
  }
  double pressureAt(double time, double temperature) {
    map(time, temperature);
    return double(map_.pressure[0]);
  }

  Calibrator calibrator_{calibration()};
  map::PressureMap map_;
};

TEST_F(LiveTemperature, FollowsTheThermometerWithTheLagOfTheSheet) {
  const double s = calibration().temperature.sensitivity, reference = calibration().temperature.reference;
  const double cold = pressureAt(0, 21), at_reference = cold / (1 + s * (21 - reference));
  EXPECT_NEAR(pressureAt(0.001, 27), cold, 1);
  const double sheet = 27 - 6 * std::exp(-1);
  EXPECT_NEAR(pressureAt(120.001, 27), at_reference * (1 + s * (sheet - reference)), 20);
  EXPECT_EQ(map_.flags[0] & map::taxel_flag::kHistoryShort, 0);
  EXPECT_NEAR(pressureAt(60, 27), at_reference * (1 + s * (27 - reference)), 20) << "time ran back";
}

TEST_F(LiveTemperature, IsLeftOutWhereTheTemperatureIsUnknown) {
  map(0, calibration().temperature.reference);
  const float pressure = map_.pressure[0], deviation = map_.deviation[0];
  map(1, NAN);
  EXPECT_EQ(map_.pressure[0], pressure) << "that of T_0";
  const double spread = calibration().temperature.spread * calibration().temperature.sensitivity * pressure;
  EXPECT_NEAR(map_.deviation[0], std::hypot(double(deviation), spread), 1);
  EXPECT_GT(map_.deviation[0], 1.5 * deviation);
  Calibrator never(calibration());
  const std::vector<std::uint16_t> counts(3, 2000);
  map::PressureMap map;
  never.calibrate({{1, 3}, 4095, counts.data(), 3}, 0, map);
  EXPECT_EQ(map.pressure[0], pressure);
}

TEST_F(LiveTemperature, IsLimitedBeyondTraining) {
  const double limit = calibration().temperature.high + CalibratorOptions{}.temperature_margin;
  const double at_limit = pressureAt(0, limit);
  EXPECT_EQ(map_.flags[0] & map::taxel_flag::kTemperatureExtrapolated, 0);
  calibrator_.setTemperature(NAN, 0, 1);
  EXPECT_NEAR(pressureAt(-1, 300), at_limit, 1e-3);
  EXPECT_NE(map_.flags[0] & map::taxel_flag::kTemperatureExtrapolated, 0);
}

}  // namespace
}  // namespace fsr::calibration
