// Plants faults of taxels and lines and checks what the detectors say of them.
#include "discrepancy/samples/faults.h"

#include <gtest/gtest.h>

#include "planted.h"

namespace fsr::discrepancy {
namespace {

std::vector<health::Fault> faultsOf(const DiscrepancyProblem& problem) {
  return findFaults(admit(problem), problem.options).faults;
}

TEST(Faults, AreNoneWhereNothingIsHidden) {
  EXPECT_TRUE(faultsOf(planted::problem(planted::kTwoSpeeds, "")).empty());
  EXPECT_TRUE(faultsOf(planted::problem(planted::kOneSurface, "")).empty());
}

TEST(Faults, AreNoneWhereAllTaxelsChangeAlike) {
  for (const char* more : {"  hysteresis: {loop_width: 0.08}\n", "  creep: {per_decade: 0.06}\n"})
    EXPECT_TRUE(faultsOf(planted::problem(planted::kTwoSpeeds, more)).empty()) << more;
}

TEST(Faults, ADeadTaxelIsNoStuckOne) {
  const std::vector<health::Fault> faults =
      faultsOf(planted::problem(planted::kTwoSpeeds, "  dead_taxel: {taxels: 1, first: 5, start: 700}\n"));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(effectOf(faults[0]).id, "dead_taxel");
  EXPECT_EQ(faults[0].taxels, std::vector<std::size_t>{5});
  EXPECT_LE(faults[0].p, 0.01);
}

health::Fault fading(double (*left)(double share)) {
  const std::vector<health::Fault> faults =
      faultsOf(planted::problemReading(planted::kTwoSpeeds, [&](const planted::Changed& now) {
        return now.taxel == 5 ? now.count * left(now.time / now.whole) : now.count;
      }));
  return faults.size() == 1 ? faults[0] : health::Fault();
}

TEST(Faults, ATaxelThatFadesToNothingIsDeadByThen) {
  const health::Fault fault = fading([](double share) { return std::max(0.0, 1 - 2 * share); });
  ASSERT_EQ(fault.taxels, std::vector<std::size_t>{5});
  EXPECT_EQ(effectOf(fault).id, "dead_taxel");
  EXPECT_NEAR(fault.fades_over, 1518, 150);
}

TEST(Faults, ATaxelThatFadesLessAndLessIsFound) {
  const health::Fault fault = fading([](double share) { return std::exp(-1.2 * share); });
  ASSERT_EQ(fault.taxels, std::vector<std::size_t>{5});
  EXPECT_EQ(effectOf(fault).id, "dead_taxel");
  EXPECT_GT(fault.fades_over, 3036) << "something is left at the end";
}

TEST(Faults, AFadeOfTheSimulationIsFoundAgain) {
  const std::vector<health::Fault> faults = faultsOf(
      planted::problem(planted::kTwoSpeeds, "  dead_taxel: {taxels: 1, first: 5, fades_over: 4000}\n"));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].taxels, std::vector<std::size_t>{5});
  EXPECT_NEAR(faults[0].fades_over, 4000, 600);
}

// Taxel 5 has the gain left(seconds) from 100 s on, and again from 400 s on, each time for 20 s.
std::vector<health::Fault> inSpells(double (*left)(double seconds)) {
  return faultsOf(planted::problemReading(planted::kTwoSpeeds, [&](const planted::Changed& now) {
    const double since = now.time - (now.time < 400 ? 100 : 400);
    return now.taxel == 5 && since >= 0 && since < 20 ? now.count * left(since) : now.count;
  }));
}

TEST(Faults, ATaxelThatLosesItsContactAndHasItAgainIsDead) {
  for (const auto left : {+[](double seconds) { return std::exp(-seconds / 8); },
                          +[](double seconds) { return std::max(0.0, 1 - seconds / 25); }}) {
    const std::vector<health::Fault> faults = inSpells(left);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].taxels, std::vector<std::size_t>{5});
    EXPECT_EQ(effectOf(faults[0]).id, "dead_taxel");
    EXPECT_GT(faults[0].fades_over, 10);
    ASSERT_EQ(faults[0].spells.size(), 2u);
    EXPECT_NEAR(faults[0].spells[0].to, 120, 2);
    EXPECT_NEAR(faults[0].spells[1].from, 400, 8);
  }
}

TEST(Faults, ATaxelThatReadsLessForAWhileDoesNotFade) {
  EXPECT_TRUE(inSpells([](double) { return 0.6; }).empty());
}

TEST(Faults, ATaxelThatGainsDoesNotFade) {
  EXPECT_TRUE(fading([](double share) { return 0.8 + 0.2 * share; }).taxels.empty());
}

// Taxels 2 and 9 stick at a count or at their unloaded one, and follow `share` of the load from then on.
DiscrepancyProblem sticking(const std::string& rig, double count, double share) {
  return planted::problemReading(rig, [=](const planted::Changed& now) {
    const bool sticks = (now.taxel == 2 || now.taxel == 9) && now.time > 0.55 * now.whole;
    return sticks ? count + share * now.count : now.count;
  });
}

TEST(Faults, ATaxelThatHardlyFollowsTheLoadAnyLongerIsStuck) {
  for (const double count : {0, 1500}) {
    for (const double share : {0.03, 0.1}) {
      const std::vector<health::Fault> faults = faultsOf(sticking(planted::kTwoSpeeds, count, share));
      ASSERT_EQ(faults.size(), 1u) << count << " " << share;
      EXPECT_EQ(effectOf(faults[0]).id, "stuck_taxel");
      EXPECT_EQ(faults[0].taxels, (std::vector<std::size_t>{2, 9}));
    }
  }
}

// On the second of three surfaces or on the last one, at its unloaded reading or with a little of the load.
TEST(Faults, ATaxelThatIsSilentOnAWholeSurfaceFails) {
  for (const std::size_t surface : {1, 2}) {
    for (const double share : {0.0, 0.03, 0.1}) {
      const std::vector<health::Fault> faults =
          faultsOf(planted::problemReading(planted::kTwoSpeeds, [&](const planted::Changed& now) {
            return now.taxel == 5 && now.recording == surface ? share * now.count : now.count;
          }));
      ASSERT_EQ(faults.size(), 1u) << surface << " " << share;
      EXPECT_EQ(effectOf(faults[0]).id, share == 0 ? "dead_taxel" : "stuck_taxel");
      EXPECT_EQ(faults[0].taxels, std::vector<std::size_t>{5});
      EXPECT_NEAR(faults[0].share, 1.0 / 3, 0.01);
    }
  }
}

// A bend changes the gain of a taxel by a share of it.
TEST(Faults, ATaxelThatABendWeakensIsSound) {
  EXPECT_TRUE(faultsOf(planted::problemReading(planted::kTwoSpeeds, [](const planted::Changed& now) {
                return now.taxel == 5 && now.recording == 1 ? now.count / 2 : now.count;
              })).empty());
}

TEST(Faults, ATaxelThatStillFollowsHalfOfTheLoadIsNotStuck) {
  for (const health::Fault& fault : faultsOf(sticking(planted::kTwoSpeeds, 800, 0.5)))
    EXPECT_NE(effectOf(fault).id, "stuck_taxel");
}

// What single taxels do of themselves is no fault, however large.
TEST(Faults, ALagOrALoopOfSingleTaxelsIsNone) {
  for (const char* more : {"  hysteresis: {loop_width: 0.25, only_taxels: [2, 9]}\n",
                           "  creep: {per_decade: 0.2, only_taxels: [2, 9]}\n"})
    EXPECT_TRUE(faultsOf(planted::problem(planted::kTwoSpeeds, more)).empty()) << more;
  for (const double step : {0.2, 0.1, 0.05}) {
    double last[12] = {};
    const std::vector<health::Fault> late =
        faultsOf(planted::problemReading(planted::kTwoSpeeds, [&](const planted::Changed& now) {
          double& lag = last[now.taxel];
          lag += (now.count - lag) * (now.taxel == 2 || now.taxel == 9 ? step : 1);
          return lag;
        }));
    EXPECT_TRUE(late.empty()) << step;
  }
}

TEST(Faults, ALineIsFoundWithItsSpells) {
  const std::vector<health::Fault> faults = faultsOf(
      planted::problem(planted::kTwoSpeeds, "  row_fault: {share: 0.04, line: 1, burst: 3, depth: 0.7}\n"));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(effectOf(faults[0]).id, "row_fault");
  EXPECT_EQ(faults[0].line, 1u);
  EXPECT_GT(faults[0].share, 0.01);
  EXPECT_LT(faults[0].share, 0.08);
}

// Three of twelve taxels are a column too often for a permutation test. Failing together decides.
TEST(Faults, AColumnOfThreeIsNotThreeTaxels) {
  const std::vector<health::Fault> faults = faultsOf(planted::problem(
      planted::kTwoSpeeds, "  column_fault: {share: 0.04, line: 1, burst: 3, depth: 0.7}\n"));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(effectOf(faults[0]).id, "column_fault");
  EXPECT_EQ(faults[0].line, 1u);
}

// A loop of one row does the same in every cycle; a loose contact does not.
TEST(Faults, ALoopOfOneRowIsNoLooseContact) {
  const std::vector<health::Fault> faults = faultsOf(
      planted::problem(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.08, only_taxels: [4, 5, 6, 7]}\n"));
  EXPECT_TRUE(faults.empty()) << effectOf(faults.front()).id;
}

// Half of a row that does something else does not make the row fail.
TEST(Faults, ALagOfHalfOfARowIsNoLooseContact) {
  double last[20] = {};
  const std::vector<health::Fault> faults =
      faultsOf(planted::problemReading(planted::withMatrix(5, 4), [&](const planted::Changed& now) {
        const bool slow = now.taxel == 9 || now.taxel == 10 || now.taxel == 13 || now.taxel == 14;
        double& lag = last[now.taxel];
        lag += (now.count - lag) * 0.01;
        return slow ? now.count - 0.1 * lag : now.count;
      }));
  EXPECT_TRUE(faults.empty()) << effectOf(faults.front()).id;
}

TEST(Faults, WhatIsSmallerThanTheLeastGapIsNone) {
  DiscrepancyProblem problem =
      planted::problem(planted::kTwoSpeeds, "  row_fault: {share: 0.04, line: 1, burst: 3, depth: 0.7}\n");
  problem.options.least_gap = 500e3;
  EXPECT_TRUE(faultsOf(problem).empty());
}

}  // namespace
}  // namespace fsr::discrepancy
