// Plants faults into the readings of a synthetic sheet and checks what is found, and that a recording and
// live scans are judged by one rule.
#include "health/faults.h"

#include <gtest/gtest.h>

#include <cmath>

#include "health/reading_rule.h"
#include "health/recorded.h"

namespace fsr::health {
namespace {

using map::taxel_flag::kDead;
using map::taxel_flag::kStuck;

// `again`: scan at which the sheet was mounted again; 0 = it was not.
std::vector<Fault> faultsOf(const dataset::Recording& recording, std::size_t again = 0) {
  Sheet sheet{recording.layout,
              double(recording.full_scale),
              {},
              std::vector<bool>(recording.layout.size.taxels(), true)};
  if (again > 0) sheet.stays.push_back({&recording, 0, again, 0, 0, {}});
  sheet.stays.push_back({&recording, again, recording.scans(), 0, 0, {}});
  for (Stay& stay : sheet.stays) {
    for (std::size_t i = stay.first; i < stay.last; ++i)
      stay.rising.push_back(i > stay.first && recording.pressure[i] > recording.pressure[i - 1]);
  }
  return findFaults(sheet).faults;
}

dataset::Recording joined(dataset::Recording recording, const dataset::Recording& more) {
  const double end = 2 * recording.time.back() - recording.time[recording.scans() - 2];
  for (const double time : more.time) recording.time.push_back(end + time);
  recording.counts.insert(recording.counts.end(), more.counts.begin(), more.counts.end());
  recording.pressure.insert(recording.pressure.end(), more.pressure.begin(), more.pressure.end());
  recording.condition.resize(recording.scans(), 0);
  return recording;
}

// Sets the readings of the taxels in the middle tenth of the recording.
template <typename Value>
dataset::Recording failing(const std::vector<std::size_t>& taxels, Value value) {
  dataset::Recording recording = recorded();
  for (std::size_t i = recording.scans() * 45 / 100; i < recording.scans() * 55 / 100; ++i)
    for (const std::size_t t : taxels)
      recording.counts[i * 20 + t] = static_cast<std::uint16_t>(value(recording.counts[i * 20 + t]));
  return recording;
}

TEST(FaultsOfASheet, AreNoneOnAHealthyOne) {
  EXPECT_TRUE(faultsOf(recorded()).empty());
}

TEST(FaultsOfASheet, AreNamedWithTheirTimes) {
  const std::vector<Fault> dead = faultsOf(failing({7}, [](int) { return 0; }));
  ASSERT_EQ(dead.size(), 1u);
  EXPECT_TRUE(dead[0].kind == FaultKind::kDeadTaxels);
  EXPECT_EQ(dead[0].taxels, std::vector<std::size_t>{7});
  EXPECT_LE(dead[0].share, 0.11);
  const std::vector<Fault> stuck = faultsOf(failing({13}, [](int) { return 1400; }));
  ASSERT_EQ(stuck.size(), 1u);
  EXPECT_TRUE(stuck[0].kind == FaultKind::kStuckTaxels);
}

// A taxel of a bent sheet reads something without load, too.
TEST(FaultsOfASheet, AreNamedWhereTheLoadEndsBeforeTheSpell) {
  test_support::SyntheticRig rig;
  rig.size = {4, 5};
  rig.surfaces = {{"cylinder", 20.0}};
  dataset::Recording recording = test_support::syntheticRecording(rig);
  for (std::size_t i = 484; i < recording.scans(); ++i) recording.counts[i * 20 + 7] = 0;
  const std::vector<Fault> dead = faultsOf(recording);
  ASSERT_EQ(dead.size(), 1u);
  EXPECT_TRUE(dead[0].kind == FaultKind::kDeadTaxels);
}

TEST(FaultsOfASheet, AreOfNoKindWhereTheTaxelStillFollowsTheLoad) {
  EXPECT_TRUE(faultsOf(failing({7}, [](int count) { return count / 2; })).empty());
}

// The slow cycle, in which the taxel keeps its reading, has most of the scans.
TEST(FaultsOfASheet, AreFoundWhereASlowCycleOutweighsTheOthers) {
  test_support::SyntheticRig rig;
  rig.size = {4, 5};
  const dataset::Recording fast = test_support::syntheticRecording(rig);
  rig.scans_per_cycle *= 10;
  rig.cycles = 1;
  dataset::Recording recording = joined(fast, test_support::syntheticRecording(rig));
  for (std::size_t i = recording.scans() - 950; i < recording.scans() - 50; ++i)
    recording.counts[i * 20 + 13] = 1400;
  const std::vector<Fault> faults = faultsOf(recording);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].kind == FaultKind::kStuckTaxels);
  EXPECT_NEAR(faults[0].share, 900.0 / double(recording.scans()), 0.05);
}

// After a new mounting the taxel loses its contact and has it again before the highest cycle.
TEST(FaultsOfASheet, AreFoundWhereOnlyHighReadingsOfAMountingAreSound) {
  test_support::SyntheticRig rig;
  rig.size = {4, 5};
  const dataset::Recording before = test_support::syntheticRecording(rig);
  rig.peak *= 0.2;
  const dataset::Recording low = test_support::syntheticRecording(rig);
  rig.peak /= 0.2;
  rig.cycles = 1;
  dataset::Recording recording = joined(joined(before, low), test_support::syntheticRecording(rig));
  const std::size_t again = before.scans(), lost = low.scans() * 9 / 10;
  for (std::size_t i = 0; i < lost; ++i) {
    std::uint16_t& count = recording.counts[(again + i) * 20 + 13];
    count = static_cast<std::uint16_t>(count * std::exp(-double(i) / 60));
  }
  const std::vector<Fault> faults = faultsOf(recording, again);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].kind == FaultKind::kDeadTaxels);
  EXPECT_NEAR(faults[0].share, double(lost) / double(recording.scans()), 0.05);
}

// In the second mounting a taxel fails for most of each of the spells, which are so near to each other that
// they make one. `reading`: of the failing taxel, from that at the begin of its spell.
template <typename Reading>
std::vector<Fault> foundWhereSpellsAreNear(Reading reading) {
  test_support::SyntheticRig rig;
  rig.size = {4, 5};
  rig.noise = 100;
  dataset::Recording recording =
      joined(test_support::syntheticRecording(rig), test_support::syntheticRecording(rig));
  const std::size_t again = recording.scans() / 2, every = 90, sound = 10;
  for (std::size_t i = again; i < recording.scans(); ++i) {
    const std::size_t since = (i - again) % every;
    if (since < sound) continue;
    recording.counts[i * 20 + 13] = reading(recording.counts[(i - since + sound - 1) * 20 + 13]);
  }
  return faultsOf(recording, again);
}

TEST(FaultsOfASheet, AreStuckTaxelsWhereOneSticksAtAnotherReadingEachTime) {
  const std::vector<Fault> faults = foundWhereSpellsAreNear([](std::uint16_t kept) { return kept; });
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].kind == FaultKind::kStuckTaxels);
  EXPECT_EQ(faults[0].taxels, std::vector<std::size_t>{13});
}

TEST(FaultsOfASheet, AreDeadTaxelsWhereOneIsOpenAgainAndAgain) {
  const std::vector<Fault> faults =
      foundWhereSpellsAreNear([](std::uint16_t kept) -> std::uint16_t { return kept % 2; });
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].kind == FaultKind::kDeadTaxels);
  EXPECT_NEAR(faults[0].share, 0.5 * 80 / 90, 0.05);
}

// The median of a line counts, so one taxel makes no line.
TEST(FaultsOfASheet, AreLinesOnlyWhereTheirTaxelsFailTogether) {
  const auto half = [](int count) { return count / 2; };
  const std::vector<Fault> row = faultsOf(failing({5, 6, 7, 8, 9}, half));
  ASSERT_EQ(row.size(), 1u);
  EXPECT_TRUE(row[0].kind == FaultKind::kRow);
  EXPECT_EQ(row[0].line, 1u);
  for (const Fault& fault : faultsOf(failing({7, 12}, half))) EXPECT_FALSE(fault.isLine());
}

// A loose contact loses two thirds of the readings of a noisy row in bursts.
TEST(FaultsOfASheet, HaveSpellsAsLongAsThePlantedOnes) {
  test_support::SyntheticRig rig;
  rig.size = {6, 10};
  rig.cycles = 20;
  rig.noise = 300;
  for (const std::size_t length : {10, 25, 60}) {
    dataset::Recording loose = test_support::syntheticRecording(rig);
    std::size_t spells = 0;
    for (std::size_t start = 60; start + length < loose.scans(); start += 230, ++spells) {
      for (std::size_t i = start; i < start + length; ++i)
        for (std::size_t t = 20; t < 30; ++t) loose.counts[i * 60 + t] /= 3;
    }
    const std::vector<Fault> faults = faultsOf(loose);
    ASSERT_EQ(faults.size(), 1u) << length;
    EXPECT_TRUE(faults[0].kind == FaultKind::kRow);
    EXPECT_EQ(faults[0].times.size(), spells) << length;
    const double share = double(spells * length) / double(loose.scans());
    EXPECT_NEAR(faults[0].share, share, 0.1 * share) << length;
  }
}

TEST(ReadingRule, CallsATaxelDeadOrStuckOnlyByWhatTheOthersDo) {
  constexpr Others kNothing{}, kLoaded{true, false, false}, kMoved{true, true, false}, kAll{true, true, true};
  EXPECT_EQ(verdictOf({0, 3, 4, 0, 4095}, kNothing), std::nullopt);
  EXPECT_EQ(verdictOf({0, 3, 4, 0, 4095}, kLoaded), kDead);
  EXPECT_EQ(verdictOf({812, 812, 4, 0, 4095}, kLoaded), std::nullopt);
  EXPECT_EQ(verdictOf({812, 812, 4, 0, 4095}, kMoved), kStuck);
  EXPECT_EQ(verdictOf({812, 813, 4, 0, 4095}, kMoved), 0);
  EXPECT_EQ(verdictOf({4095, 4095, 4, 0, 4095}, kMoved), std::nullopt);
  EXPECT_EQ(verdictOf({4095, 4095, 4, 0, 4095}, kAll), kStuck);
}

}  // namespace
}  // namespace fsr::health
