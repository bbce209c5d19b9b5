// The model of the sheet's memory: its operators, its fit, and the state of a live map.

#include "fsr_pressure_map/calibration/history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "calibration/stages/memory/history_fit.h"
#include "calibration/stages/memory/history_state.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/allocation_guard.h"

namespace fsr::calibration {
namespace {

// Coefficients as a fit would give them.
HistoryModel model() {
  HistoryModel model;
  model.family = HistoryFamily::kBoth;
  model.knot = {0, 200e3, 400e3};
  model.correction = {1e3, -2e3, 3e3};
  model.radius = {10e3, 50e3};
  model.play_weight = {-0.2, -0.1};
  model.time_constant = {0.5, 4};
  model.memory_weight = {0.05, 0.02};
  model.deviation_knot = {0, 400e3};
  model.loading_deviation = {2e3, 2e3};
  model.unloading_deviation = {3e3, 3e3};
  return model;
}

TEST(HistoryModel, NamesItsFamilies) {
  EXPECT_EQ(historyName(historyFromName("plays")), "plays");
  EXPECT_THROW(historyFromName("loop"), settings::InputError);
}

// /usr/bin/python3 -c "
// from math import exp
// from scipy.optimize import brentq
// print(brentq(lambda t: .05*4e5*exp(-t/.5) + .02*4e5*exp(-t/4) - 2e3, 0, 12))"
TEST(HistoryModel, IsSettledOnceTheMemoriesOweLessThanTheSmallestDeviation) {
  HistoryModel own = model();
  EXPECT_NEAR(own.settlingTime(), 5.5458, 2e-3);
  own.loading_deviation = {30e3};
  own.unloading_deviation = {40e3};
  EXPECT_DOUBLE_EQ(own.settlingTime(), 0) << "they never owe as much";
  own.loading_deviation = own.unloading_deviation = {1};
  EXPECT_DOUBLE_EQ(own.settlingTime(), 12) << "at most three of the longest time constant";
  own.time_constant.clear();
  own.memory_weight.clear();
  EXPECT_DOUBLE_EQ(own.settlingTime(), 0);
}

TEST(HistoryModel, KnowsWhatThePlaysOwe) {
  const HistoryModel own = model();  // 0.2 x 10 kPa, 0.1 x 50 kPa
  EXPECT_NEAR(own.playsOwe(300e3, 300e3), 2e3 + 5e3, 1e-9) << "one reading: nothing is known";
  EXPECT_NEAR(own.playsOwe(300e3, 330e3), 0.1 * 35e3, 1e-9) << "the narrow play has turned";
  EXPECT_NEAR(own.playsOwe(300e3, 400e3), 0, 1e-9);
  EXPECT_NEAR(own.playsOwe(4e3, 4e3), 0.2 * 2e3 + 0.1 * 2e3, 1e-9) << "close to rest the plays are known";
  EXPECT_NEAR(own.playsOwe(-1e3, -1e3), 0, 1e-9);
}

// A sheet that was conditioned and lies at rest is on the branch of unloading, as in training.
TEST(HistoryOperators, StartInTheMiddleOfWhatIsPossible) {
  const HistoryOperators operators({10e3, 50e3}, {4});
  std::vector<double> state(3);
  const auto started = [&](double x) {
    operators.startConditioned(x, state.data());
    return state;
  };
  EXPECT_EQ(started(0), (std::vector<double>{10e3, 50e3, 0}));
  EXPECT_EQ(started(-2e3), (std::vector<double>{8e3, 48e3, -2e3})) << "no further than a play may be";
  EXPECT_EQ(started(40e3), (std::vector<double>{40e3, 70e3, 40e3}));
  EXPECT_EQ(started(200e3), (std::vector<double>{200e3, 200e3, 200e3}));
}

// Answer of a taxel that gets these static answers, `step` seconds apart.
std::vector<float> answers(HistoryState& state, const std::vector<double>& x, double step) {
  std::vector<float> result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    float pressure = float(x[i]), deviation = 1;
    state.beginScan(double(i) * step);
    state.correct(0, false, pressure, deviation);
    result.push_back(pressure);
  }
  return result;
}

// /usr/bin/python3 -c "
// import numpy as np
// x=np.array([0,100e3,250e3,250e3,120e3,180e3]); dt=1.0
// def play(r):
//     o=x[0]+r; out=[]
//     for v in x: o=min(max(o,v-r),v+r); out.append(o)
//     return np.array(out)
// def ema(tau):
//     m=x[0]; out=[m]
//     for a,b in zip(x,x[1:]):  # 1000 small steps of a line, implicit midpoint
//         for k in range(1000):
//             u=a+(b-a)*(k+.5)/1000; h=dt/1000/tau; m=(m*(1-h/2)+h*u)/(1+h/2)
//         out.append(m)
//     return np.array(out)
// c=np.interp(x,[0,200e3,400e3],[1e3,-2e3,3e3])
// p=x+c-.2*(play(10e3)-x)-.1*(play(50e3)-x)+.05*(ema(.5)-x)+.02*(ema(4)-x)
// print(np.round(p,1))"
TEST(HistoryState, AnswersAsNumpyDoes) {
  HistoryState state(model(), 1);
  state.rest();
  const std::vector<float> own = answers(state, {0, 100e3, 250e3, 250e3, 120e3, 180e3}, 1.0);
  const std::vector<double> expected = {-6000.0, 102568.7, 248682.4, 252631.0, 114800.0, 179199.6};
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(own[i], expected[i], 0.2) << i;
}

TEST(HistoryState, GivesTheStaticAnswerUntilItIsSettled) {
  HistoryState state(model(), 1);
  float pressure = 100e3, deviation = 7;
  state.beginScan(0);
  EXPECT_FALSE(state.correct(0, false, pressure, deviation));
  EXPECT_EQ(pressure, 100e3f);
  EXPECT_EQ(deviation, 7);
  const auto corrected = [&](double time, float x) {
    pressure = x, deviation = 7;
    state.beginScan(time);
    return state.correct(0, false, pressure, deviation);
  };
  EXPECT_FALSE(corrected(5, 250e3)) << "the plays owe nothing, the time is short";
  EXPECT_TRUE(corrected(13, 250e3));
  EXPECT_NE(pressure, 250e3f);
  EXPECT_EQ(deviation, 2e3f) << "loading";
  EXPECT_TRUE(corrected(14, 100e3));
  EXPECT_EQ(deviation, 3e3f) << "unloading";
  EXPECT_FALSE(corrected(13.5, 100e3)) << "time ran back";
}

TEST(HistoryState, AtRestIsSettledWithoutAChangeOfLoad) {
  HistoryState state(model(), 2);
  const auto corrected = [&](double time, std::size_t taxel, float pressure) {
    float deviation = 7;
    state.beginScan(time);
    return state.correct(taxel, false, pressure, deviation);
  };
  for (double time = 0; time < 5.5; time += 0.5) {
    EXPECT_FALSE(corrected(time, 0, 1e3f));
    EXPECT_FALSE(corrected(time, 1, 100e3f));
  }
  EXPECT_TRUE(corrected(6, 0, 1e3f));
  EXPECT_FALSE(corrected(6, 1, 100e3f)) << "under load its plays may be anywhere";
}

TEST(HistoryState, ForgetsAfterAGapAndOnRequest) {
  HistoryState state(model(), 2);
  const auto corrected = [&](double time) {
    state.beginScan(time);
    std::vector<bool> result;
    for (std::size_t taxel = 0; taxel < 2; ++taxel) {
      float pressure = 100e3, deviation = 7;
      result.push_back(state.correct(taxel, false, pressure, deviation));
    }
    return result;
  };
  state.rest();
  EXPECT_EQ(corrected(0), (std::vector<bool>{true, true}));
  state.forget(1);
  EXPECT_EQ(corrected(1), (std::vector<bool>{true, false}));
  EXPECT_EQ(corrected(14), (std::vector<bool>{false, false})) << "a gap longer than the settling time";
}

// One memory of 30 s and a tenth of the pressure, deviations of 1 kPa: settled 90 s after it knows nothing.
HistoryModel slowModel() {
  HistoryModel own = model();
  own.family = HistoryFamily::kMemories;
  own.correction = {0, 0, 0};
  own.radius.clear();
  own.play_weight.clear();
  own.time_constant = {30};
  own.memory_weight = {0.1};
  own.loading_deviation = own.unloading_deviation = {1e3, 1e3};
  return own;
}

// A taxel of a sheet that is loaded to 400 kPa at 0 s and has no reading until `back` [s].
class Spell {
 public:
  Spell(const HistoryModel& model, double back, double step) : state_(model, 1) {
    state_.rest();
    at(0, 0);
    for (double time = step; time < back - step / 2; time += step) EXPECT_FALSE(at(time, 400e3, true));
  }
  bool at(double time, double x, bool frozen = false) {
    pressure = float(x), deviation = 7e3;
    state_.beginScan(time);
    return state_.correct(0, frozen, pressure, deviation);
  }
  float pressure = 0, deviation = 0;

 private:
  HistoryState state_;
};

TEST(HistoryState, AfterALongSpellWithoutReadingsHasTheStaticAnswerAndDeviation) {
  Spell saturated(slowModel(), 120, 1);
  EXPECT_FALSE(saturated.at(120, 400e3));
  EXPECT_EQ(saturated.pressure, 400e3f) << "the sheet's memory has followed: no 360 kPa";
  EXPECT_EQ(saturated.deviation, 7e3f);
  for (double time = 121; time < 209.5; ++time) EXPECT_FALSE(saturated.at(time, 400e3)) << time;
  EXPECT_TRUE(saturated.at(210, 400e3));
  EXPECT_NEAR(saturated.pressure, 400e3, 1);
}

// Evenly from 0 to 400 kPa within 30 s, 90 s at 400 kPa:
// /usr/bin/python3 -c "from math import exp; m=400*(1-(1-exp(-1))); print(400+.1*((m-400)*exp(-3)))"
TEST(HistoryState, StepsOverASpellWithoutReadingsByItsTime) {
  Spell saturated(slowModel(), 30, 1);
  for (double time = 30; time < 119.5; ++time) EXPECT_FALSE(saturated.at(time, 400e3)) << time;
  EXPECT_TRUE(saturated.at(120, 400e3));
  EXPECT_NEAR(saturated.pressure, 398741.1, 1);
}

TEST(HistoryState, StaysSettledOverASpellThatItsMemoriesHardlyFeel) {
  Spell one_scan(slowModel(), 0.02, 0.01);
  EXPECT_TRUE(one_scan.at(0.02, 1e3));
  Spell with_plays(model(), 0.02, 0.01);
  EXPECT_FALSE(with_plays.at(0.02, 200e3)) << "its plays may be anywhere";
  EXPECT_TRUE(with_plays.at(0.03, 300e3)) << "which a change of load ends";
}

// The way from there down to the reading moves all plays of 50 kPa and less.
TEST(HistoryState, KnowsItsPlaysAfterASaturatedSpellThatEndsFarBelow) {
  HistoryModel plays = model();
  plays.family = HistoryFamily::kPlays;
  plays.time_constant.clear();
  plays.memory_weight.clear();
  const auto settledAt = [&](double pressure) {
    HistoryState state(plays, 1);
    state.rest();
    float answer = 0, deviation = 1;
    state.beginScan(0);
    state.correct(0, false, answer, deviation);
    state.beginScan(1);
    state.atLeast(0, 400e3);
    EXPECT_FALSE(state.correct(0, true, answer, deviation));
    state.beginScan(2);
    answer = float(pressure);
    const bool settled = state.correct(0, false, answer, deviation);
    // c = 1 kPa - 15 Pa / kPa; both plays on the branch of unloading: -0.2 x 10 - 0.1 x 50 kPa
    if (settled) {
      EXPECT_NEAR(double(answer), pressure + 1e3 - 0.015 * pressure - 7e3, 1);
    }
    return settled;
  };
  EXPECT_TRUE(settledAt(100e3));
  EXPECT_FALSE(settledAt(380e3));
}

TEST(HistoryState, DoesNotTakeTheFirstReadingAfterASpellForTheRest) {
  HistoryState state(slowModel(), 1);
  state.rest();
  float pressure = 400e3, deviation = 7e3;
  state.beginScan(0);
  EXPECT_FALSE(state.correct(0, true, pressure, deviation));
  state.beginScan(1);
  EXPECT_FALSE(state.correct(0, false, pressure, deviation));
}

// Whatever the readings, the answer stays within what the weights permit; a reading that is not finite is
// none.
TEST(HistoryState, IsBoundedForAnyReadings) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1e5, 7e5);
  const HistoryModel own = model();
  // |c| <= 3 kPa, plays <= sum |w| r = 7 kPa, memories <= 0.07 x 800 kPa
  const double bound = 3e3 + 7e3 + 0.07 * 8e5;
  HistoryState state(own, 1);
  double time = 0;
  for (int i = 0; i < 200000; ++i) {
    const int kind = int(random() % 50);
    time += kind == 0 ? -1.0 : kind == 1 ? 100.0 : kind == 2 ? 0.0 : 1e-3 * double(random() % 3000);
    const double x = kind == 3 ? std::numeric_limits<double>::quiet_NaN() : kind == 4 ? 1e38 : any(random);
    if (kind == 5) state.rest();
    float pressure = float(x), deviation = 7;
    state.beginScan(kind == 6 ? std::numeric_limits<double>::quiet_NaN() : time);
    const bool corrected = state.correct(0, kind == 4, pressure, deviation);
    if (corrected) {
      ASSERT_LE(std::abs(double(pressure) - x), bound) << i;
      ASSERT_GT(deviation, 0);
    } else if (kind != 3) {
      ASSERT_EQ(pressure, float(x));
    }
  }
}

TEST(HistoryState, AllocatesNothing) {
  HistoryState state(model(), 70);
  const test_support::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    state.beginScan(0.013 * i * i);
    for (std::size_t taxel = 0; taxel < 70; ++taxel) {
      float pressure = float(1000 * i), deviation = 1;
      state.correct(taxel, false, pressure, deviation);
    }
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

// x as a Prandtl-Ishlinskii loop reads it, on the radii of the grid: the inverse is of the model's form.
TEST(HistoryFit, RecoversALoopThatItsFormContains) {
  const HistoryGrid grid = historyGrid(600e3, 30);
  const HistoryOperators operators = operatorsOf(grid);
  std::vector<double> state(operators.size()), features(grid.features());
  std::vector<rheology::ExponentialMemory::Step> steps(operators.memories());
  operators.stepsOver(0.1, steps.data());
  operators.start(0, state.data());
  HistorySums sums(grid.features());
  double last = 0;
  for (int i = 0; i < 8000; ++i) {
    const double x = 300e3 * (1 - std::cos(i * 0.004)) * (0.6 + 0.4 * std::sin(i * 0.0007));
    operators.advance(last, x, steps.data(), state.data());
    last = x;
    historyFeatures(grid, x, state.data(), features.data());
    const std::size_t plays = grid.knots.size();
    sums.add(features.data(), -0.3 * features[plays + 1] - 0.1 * features[plays + 3]);
  }
  sums.finish();
  const Eigen::VectorXd fitted = fitHistory(HistoryFamily::kPlays, grid, sums);
  const HistoryModel own = historyModel(HistoryFamily::kPlays, grid, fitted);
  ASSERT_EQ(own.radius, (std::vector<double>{grid.radii[1], grid.radii[3]}));
  EXPECT_NEAR(own.play_weight[0], -0.3, 1e-3);
  EXPECT_NEAR(own.play_weight[1], -0.1, 1e-3);
  EXPECT_TRUE(own.time_constant.empty());
  EXPECT_LT(std::sqrt(sums.meanSquare(fitted)), 20);
}

TEST(HistoryGrid, HasNoMemoryLongerThanAThirdOfTheLongestHold) {
  EXPECT_EQ(historyGrid(600e3, 0).time_constants, (std::vector<double>{0.3}));
  const HistoryGrid grid = historyGrid(600e3, 90);
  EXPECT_EQ(grid.time_constants.size(), 6u);
  EXPECT_NEAR(grid.time_constants.back(), 30, 1e-9);
}

}  // namespace
}  // namespace fsr::calibration
