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

// A sheet that was conditioned and lies at rest is on the branch of unloading, as in training.
TEST(HistoryOperators, StartInTheMiddleOfWhatIsPossible) {
  const HistoryOperators operators({10e3, 50e3}, {4}, 400e3);
  std::vector<double> state(3), open(3);
  const auto started = [&](double x) {
    operators.start(x, state.data(), open.data());
    return std::pair(state, open);
  };
  using Numbers = std::vector<double>;
  EXPECT_EQ(started(0), std::pair(Numbers({10e3, 50e3, 0}), Numbers({0, 0, 1})));
  EXPECT_EQ(started(-2e3), std::pair(Numbers({8e3, 48e3, -2e3}), Numbers({0, 0, 1})));
  EXPECT_EQ(started(40e3), std::pair(Numbers({40e3, 70e3, 40e3}), Numbers({10e3, 20e3, 1})));
  EXPECT_EQ(started(200e3), std::pair(Numbers({200e3, 200e3, 200e3}), Numbers({10e3, 50e3, 1})));
  EXPECT_EQ(started(400e3), std::pair(Numbers({390e3, 350e3, 400e3}), Numbers({0, 0, 1})))
      << "at the highest load it is on the branch of loading";
}

// Inputs of a random walk that turns at random, between 0 and 400 kPa.
class RandomLoad {
 public:
  explicit RandomLoad(unsigned seed) : random_(seed) {}
  double next() {
    std::uniform_real_distribution<double> share(0, 1);
    if (share(random_) < 0.05) rate_ = 40e3 * (share(random_) - 0.5);
    x_ = std::min(std::max(x_ + rate_, 0.0), 400e3);
    return x_;
  }
  std::mt19937& random() { return random_; }

 private:
  std::mt19937 random_;
  double x_ = 0, rate_ = 0;
};

// Whoever begins to look in the middle of a history, and misses parts of it, has each play in its interval.
TEST(HistoryOperators, HaveTheTrueStateOfEachPlayInTheirInterval) {
  const std::vector<double> radii = {8e3, 40e3, 140e3};
  const HistoryOperators operators(radii, {}, 400e3);
  int closed = 0, narrow = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    RandomLoad load(seed);
    std::vector<double> truth = radii, state(3), open(3);  // conditioned: at rest on the branch of unloading
    const std::size_t begins = seed % 90;
    double last = 0, limit = -HistoryOperators::kNone;
    std::size_t unseen = 0;
    for (std::size_t i = 0; i < 600; ++i) {
      const double x = load.next();
      operators.advance(last, x, nullptr, truth.data());
      last = x;
      if (i < begins) continue;
      const std::vector<double> before = open;
      if (i == begins) {
        operators.start(x, state.data(), open.data());
      } else if (load.random()() % 150 == 0 || (unseen > 0 && unseen < 20)) {
        ++unseen;
        limit = x - 5e3;
        continue;
      } else if (unseen > 0) {
        operators.advanceUnseen(0, x, seed % 2 == 0 ? limit : -HistoryOperators::kNone, nullptr, state.data(),
                                open.data());
        limit = -HistoryOperators::kNone;
        unseen = 0;
      } else {
        operators.advanceOpen(0, x, nullptr, state.data(), open.data());
        for (std::size_t j = 0; j < 3; ++j) ASSERT_LE(open[j], before[j] + 1e-6) << "it only narrows";
      }
      for (std::size_t j = 0; j < 3; ++j)
        ASSERT_LE(std::abs(truth[j] - state[j]), open[j] + 1e-6) << seed << ' ' << i << ' ' << j;
      closed += open[2] == 0;
      narrow += open[0] == 0;
    }
  }
  EXPECT_GT(closed, 10000);
  EXPECT_GT(narrow, closed) << "plays settle one by one";
}

// e^(-27 / 4) = 0.0012, e^(-28 / 4) = 0.0009. Training and live maps take this step.
TEST(HistoryOperators, AreKnownOnceLessThanAThousandthIsOpen) {
  const HistoryOperators operators({}, {4}, 400e3);
  HistoryTaxel own;
  double state = 0, open = 0;
  std::vector<HistoryOperators::Step> steps(1);
  operators.stepsOver(1, steps.data());
  const auto none = [&](double) { return steps.data(); };
  for (int time = 0; time <= 27; ++time) {
    operators.meet(own, 100e3, time, time - 1, steps.data(), none, &state, &open);
    EXPECT_TRUE(own.open) << time;
  }
  operators.meet(own, 100e3, 28, 27, steps.data(), none, &state, &open);
  EXPECT_FALSE(own.open);
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

// What a live map shows of one taxel.
struct Shown {
  HistoryAnswer answer = HistoryAnswer::kNoReading;
  double pressure = 0, deviation = 0;  // [Pa]
};

Shown shown(HistoryState& state, double time, double x, std::size_t taxel = 0, bool frozen = false) {
  float pressure = float(x), deviation = 7;
  state.beginScan(time);
  const HistoryAnswer answer = state.correct(taxel, frozen, pressure, deviation);
  return {answer, double(pressure), double(deviation)};
}

HistoryModel playsAlone() {
  HistoryModel plays = model();
  plays.family = HistoryFamily::kPlays;
  plays.time_constant.clear();
  plays.memory_weight.clear();
  return plays;
}

// Under 200 kPa both plays are open by their radius: 0.2 x 10 + 0.1 x 50 = 7 kPa beside 2 kPa.
TEST(HistoryState, NarrowsItsDeviationWhileTheLoadMoves) {
  HistoryState state(playsAlone(), 1);
  const Shown first = shown(state, 0, 200e3);
  EXPECT_EQ(first.answer, HistoryAnswer::kOpen);
  EXPECT_NEAR(first.pressure, 200e3, 1) << "the static answer, since nothing is known";
  EXPECT_NEAR(first.deviation, 7e3 + 0.8 * 2e3, 1);
  double before = first.deviation;
  for (int i = 1; i <= 100; ++i) {
    const Shown own = shown(state, i, 200e3 + 1e3 * i);
    EXPECT_LE(own.deviation, before + 1e-3) << i;
    before = own.deviation;
    if (i == 20) {
      EXPECT_NEAR(own.deviation, 0.1 * 40e3 + 0.8 * 2e3, 1) << "one is known";
    }
    EXPECT_EQ(own.answer == HistoryAnswer::kSettled, own.deviation <= 4e3) << "twice the settled deviation";
  }
  EXPECT_EQ(before, 2e3) << "the load has turned by twice the widest radius";
  EXPECT_EQ(shown(state, 50, 300e3).answer, HistoryAnswer::kOpen) << "time ran back";
}

// (0.05 e^(-t / 0.5) + 0.02 e^(-t / 4)) x spread
TEST(HistoryState, NarrowsItsDeviationAsItsMemoriesFill) {
  HistoryModel memories = model();
  memories.family = HistoryFamily::kMemories;
  memories.radius.clear();
  memories.play_weight.clear();
  memories.memory_spread = {100e3, 200e3};
  HistoryState state(memories, 1);
  EXPECT_NEAR(shown(state, 0, 200e3).deviation, 9e3 + 0.8 * 2e3, 1);
  EXPECT_NEAR(shown(state, 1, 200e3).deviation, 5e3 * std::exp(-2.0) + 4e3 * std::exp(-0.25) + 0.8 * 2e3, 1);
  EXPECT_EQ(shown(state, 4, 200e3).answer, HistoryAnswer::kSettled);
  EXPECT_EQ(shown(state, 40, 200e3).deviation, 2e3);
  memories.memory_spread.clear();  // a file of an earlier version: 400 kPa / sqrt(12)
  HistoryState old(memories, 1);
  EXPECT_NEAR(shown(old, 0, 200e3).deviation, 0.07 * 400e3 / std::sqrt(12.0) + 0.8 * 2e3, 1);
}

// Readings whose operators are at one of the ends of `open`. The settled error is normal; it has the side of
// that end in half of the readings.
TEST(WithOpen, HoldsAsManyReadingsWhateverIsOpen) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1e3);
  for (const double open : {0.0, 0.3e3, 1e3, 2e3, 5e3, 20e3}) {
    int within = 0;
    for (int i = 0; i < 20000; ++i) {
      const double own = normal(random);
      within += std::abs(open + (i % 2 == 0 ? std::abs(own) : own)) <= withOpen(1e3, open);
    }
    EXPECT_NEAR(within / 20000.0, 0.683, 0.05) << open;
    EXPECT_NEAR(withoutOpen(withOpen(1e3, open), open), 1e3, 1e-6) << open;
  }
  EXPECT_EQ(withoutOpen(1e3, 2e3), 0);
}

// As a socket is worn: staircases that never return to rest.
TEST(HistoryState, SettlesUnderALoadThatNeverReturnsToRest) {
  HistoryState worn(model(), 1), rested(model(), 1);
  rested.rest();
  double settled_after = -1, difference = 0;
  const auto course = [](double time) {  // 60 to 250 kPa, turns every 50 s
    const double phase = std::fmod(time, 100.0) / 50;
    return 60e3 + 190e3 * (phase < 1 ? phase : 2 - phase);
  };
  for (double time = 0; time < 100; time += 0.5) shown(rested, time, time < 50 ? 6e3 * time : 300e3);
  for (double time = 100; time < 400; time += 0.5) {
    const Shown own = shown(worn, time, course(time)), full = shown(rested, time, course(time));
    if (settled_after < 0 && own.answer == HistoryAnswer::kSettled) settled_after = time - 100;
    if (time > 200) difference = std::max(difference, std::abs(own.pressure - full.pressure));
  }
  EXPECT_GE(settled_after, 0);
  EXPECT_LE(settled_after, 100) << "two turns";
  EXPECT_LT(difference, 1);
}

TEST(HistoryState, AtRestIsSettledWithoutAChangeOfLoad) {
  HistoryState state(playsAlone(), 2);
  EXPECT_EQ(shown(state, 0, 1e3, 0).answer, HistoryAnswer::kSettled);
  EXPECT_EQ(shown(state, 0, 200e3, 1).answer, HistoryAnswer::kOpen) << "under load its plays may be anywhere";
  state.rest();
  EXPECT_EQ(shown(state, 1, 200e3, 1).deviation, 2e3) << "it is known that it rests";
}

// The model alone subtracts 6 kPa at rest and adds 2.6 kPa at 100 kPa.
TEST(HistoryState, ChangesNoAnswerByMoreThanTraining) {
  HistoryModel limited = model();
  limited.least_change = {-2e3, -2e3, -2e3};
  limited.largest_change = {0, 1e3, 2e3};
  HistoryState state(limited, 1);
  state.rest();
  const std::vector<float> own = answers(state, {0, 100e3}, 1.0);
  EXPECT_NEAR(own[0], -2e3, 1e-3);
  EXPECT_NEAR(own[1], 100.5e3, 0.1);
}

TEST(HistoryState, ForgetsOnRequest) {
  HistoryState state(model(), 2);
  const auto settled = [&](double time) {
    std::vector<bool> result;
    for (std::size_t taxel = 0; taxel < 2; ++taxel)
      result.push_back(shown(state, time, 200e3, taxel).answer == HistoryAnswer::kSettled);
    return result;
  };
  state.rest();
  EXPECT_EQ(settled(0), (std::vector<bool>{true, true}));
  state.forget(1);
  EXPECT_EQ(settled(1), (std::vector<bool>{true, false}));
  EXPECT_EQ(settled(62), (std::vector<bool>{false, false})) << "a gap of more than a minute";
}

// One memory of 30 s and a tenth of the pressure, deviations of 1 kPa.
HistoryModel slowModel() {
  HistoryModel own = model();
  own.family = HistoryFamily::kMemories;
  own.correction = {0, 0, 0};
  own.radius.clear();
  own.play_weight.clear();
  own.time_constant = {30};
  own.memory_weight = {0.1};
  own.memory_spread = {100e3};
  own.loading_deviation = own.unloading_deviation = {1e3, 1e3};
  return own;
}

// A taxel that rests at 0 s and has no reading until `back` [s], when it reads 400 kPa.
Shown afterSpell(HistoryState& state, double back, double step) {
  state.rest();
  shown(state, 0, 0);
  for (double time = step; time < back - step / 2; time += step)
    EXPECT_EQ(shown(state, time, 400e3, 0, true).pressure, 400e3) << "no reading, no correction";
  return shown(state, back, 400e3);
}

// Evenly from 0 to 400 kPa within 30 s: 63 % of the memory stem from what was not seen.
// /usr/bin/python3 -c "from math import exp
// m=400*(1-(1-exp(-1))); print(400+.1*(m-400)); print(.8+10*(1-exp(-1)))
// print(400+.1*(m-400)*exp(-3)); print(.8+10*(1-exp(-1))*exp(-3))"
TEST(HistoryState, StepsOverASpellWithoutReadingsByItsTime) {
  HistoryState state(slowModel(), 1);
  const Shown back = afterSpell(state, 30, 1);
  EXPECT_EQ(back.answer, HistoryAnswer::kOpen);
  EXPECT_NEAR(back.pressure, 374715.2, 1);
  EXPECT_NEAR(back.deviation, 7121.2, 1);
  Shown own;
  for (double time = 31; time < 120.5; ++time) own = shown(state, time, 400e3);
  EXPECT_EQ(own.answer, HistoryAnswer::kSettled);
  EXPECT_NEAR(own.pressure, 398741.1, 1);
  EXPECT_NEAR(own.deviation, 1114.7, 1);
}

TEST(HistoryState, StaysSettledOverASpellThatItsMemoriesHardlyFeel) {
  HistoryState memory(slowModel(), 1), with_plays(model(), 1);
  EXPECT_EQ(afterSpell(memory, 0.02, 0.01).answer, HistoryAnswer::kSettled);
  with_plays.rest();
  shown(with_plays, 0, 0);
  shown(with_plays, 0.01, 0, 0, true);
  EXPECT_EQ(shown(with_plays, 0.02, 200e3).answer, HistoryAnswer::kOpen) << "its plays may be anywhere";
  EXPECT_EQ(shown(with_plays, 0.03, 300e3).answer, HistoryAnswer::kSettled) << "which a change of load ends";
}

// The way from there down to the reading moves all plays of 50 kPa and less.
TEST(HistoryState, KnowsItsPlaysAfterASaturatedSpellThatEndsFarBelow) {
  const auto after = [&](double pressure) {
    HistoryState state(playsAlone(), 1);
    state.rest();
    shown(state, 0, 0);
    state.beginScan(1);
    state.atLeast(0, 400e3);
    shown(state, 1, 0, 0, true);
    return shown(state, 2, pressure);
  };
  // c = 1 kPa - 15 Pa / kPa; both plays on the branch of unloading: -0.2 x 10 - 0.1 x 50 kPa
  const Shown far_below = after(100e3);
  EXPECT_NEAR(far_below.pressure, 100e3 + 1e3 - 1.5e3 - 7e3, 1);
  EXPECT_EQ(far_below.deviation, 3e3) << "unloading, all is known";
  EXPECT_GT(after(380e3).deviation, 3e3);
}

TEST(HistoryState, DoesNotTakeTheFirstReadingAfterASpellForTheRest) {
  HistoryState state(slowModel(), 1);
  state.rest();
  shown(state, 0, 400e3, 0, true);
  EXPECT_EQ(shown(state, 1, 200e3).answer, HistoryAnswer::kOpen);
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
    const HistoryAnswer answer = state.correct(0, kind == 4, pressure, deviation);
    if (answer != HistoryAnswer::kNoReading) {
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
  const HistoryGrid grid = historyGrid(0, 600e3, 30);
  const HistoryOperators operators = operatorsOf(grid);
  std::vector<double> state(operators.size()), open(operators.size()), features(grid.features());
  std::vector<rheology::ExponentialMemory::Step> steps(operators.memories());
  operators.stepsOver(0.1, steps.data());
  operators.start(0, state.data(), open.data());
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
  const HistoryModel own = historyModel(HistoryFamily::kPlays, grid, fitted, memorySpreads(grid, sums));
  ASSERT_EQ(own.radius, (std::vector<double>{grid.radii[1], grid.radii[3]}));
  EXPECT_NEAR(own.play_weight[0], -0.3, 1e-3);
  EXPECT_NEAR(own.play_weight[1], -0.1, 1e-3);
  EXPECT_TRUE(own.time_constant.empty());
  EXPECT_LT(std::sqrt(sums.meanSquare(fitted)), 20);
}

TEST(HistoryGrid, HasRadiiOfTheTrainedRange) {
  const HistoryGrid grid = historyGrid(100e3, 300e3, 30);
  EXPECT_NEAR(grid.radii.back(), 0.35 * 200e3, 1e-6);
  EXPECT_EQ(grid.knots.front(), 100e3);
  EXPECT_EQ(grid.knots.back(), 300e3);
}

TEST(HistoryGrid, ContinuesTheMeasuredMemoriesByADecade) {
  EXPECT_EQ(historyGrid(0, 600e3, 0).time_constants, (std::vector<double>{0.3}));
  const HistoryGrid grid = historyGrid(0, 600e3, 90);
  EXPECT_EQ(grid.time_constants.size(), 8u);
  EXPECT_NEAR(grid.longestMeasured(), 30, 1e-9) << "a third of the longest hold";
  EXPECT_NEAR(grid.time_constants.back(), 300, 1e-9);
}

// Readings that tell nothing of the decade beyond: creep goes on as the logarithm of time.
TEST(HistoryFit, ContinuesTheWeightOfTheLongestMeasuredMemory) {
  const HistoryGrid grid = historyGrid(0, 600e3, 90);
  const std::size_t longest = grid.features() - 1 - grid.continued;
  HistorySums sums(grid.features());
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> features(grid.features(), 0.0);
    features[0] = 1;
    features[longest] = 100e3 * std::sin(0.01 * i);
    sums.add(features.data(), -0.03 * features[longest]);
  }
  sums.finish();
  const Eigen::VectorXd fitted = fitHistory(HistoryFamily::kMemories, grid, sums);
  for (std::size_t k = longest; k < grid.features(); ++k)
    EXPECT_NEAR(fitted[Eigen::Index(k)], -0.03, 1e-3) << k;
}

TEST(HistoryFit, LimitsTheChangeToThatOfTheReadingsNearEachKnot) {
  const HistoryGrid grid = historyGrid(0, 160e3, 90);  // a knot every 10 kPa
  ChangeRange range(grid), other(grid);
  range.add(20e3, -1e3);
  other.add(24e3, 2e3);
  other.add(30e3, 4e3);
  range.merge(other);
  range.finish();
  EXPECT_EQ(range.limited(20e3, -3e3), -1e3);
  EXPECT_EQ(range.limited(20e3, 1e3), 1e3);
  EXPECT_EQ(range.limited(25e3, 9e3), 3e3) << "between the knots";
  EXPECT_EQ(range.limited(100e3, 0), 4e3) << "that of the neighbour";
  EXPECT_EQ(range.limited(0, 9e3), 2e3);
}

}  // namespace
}  // namespace fsr::calibration
