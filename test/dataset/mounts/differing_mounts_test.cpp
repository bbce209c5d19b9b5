#include "dataset/mounts.h"

#include <gtest/gtest.h>

#include <iostream>

#include "support/holds.h"
#include "support/mounted_day.h"

namespace fsr::dataset {
namespace {

using test_support::recorded;

TEST(DifferingMounts, OfTwoMountsEitherMayBeWrong) {
  const auto remarks = remarksOnDifferingMounts(recorded({"bench", 2, true}));
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_EQ(remarks[0].recording, 4u);
  EXPECT_TRUE(test_support::holds(
      remarks[0].sentence, {"1 (1_cylinder_10cm.bag)", "5 (5_cylinder_10cm.bag)", "9.7 kPa", "0.0 kPa"}));
}

TEST(DifferingMounts, OfThreeMountsTheWrongOneIsNamed) {
  const auto remarks = remarksOnDifferingMounts(recorded({"bench", 3, true}));
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_EQ(remarks[0].recording, 4u);
  EXPECT_EQ(remarks[0].sentence.find("cylinder_10cm: mount 5 (5_cylinder_10cm.bag) differs by "), 0u);
  EXPECT_NE(remarks[0].sentence.find(" from the other 2 mounts of this surface"), std::string::npos);
}

TEST(DifferingMounts, ACleanDayHasNone) {
  for (const std::string rig : {"bench", "demo", "remounted"})
    EXPECT_TRUE(remarksOnDifferingMounts(recorded({rig})).empty()) << rig;
}

TEST(DifferingMounts, WhatMayBeChanceIsToldWithItsShare) {
  const auto remarks = remarksOnDifferingMounts(recorded({"demo", 2, true, 101}));
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_FALSE(remarks[0].certain());
  EXPECT_LT(remarks[0].by_chance, 0.5);
  EXPECT_NE(remarks[0].sentence.find("mount 5"), std::string::npos) << remarks[0].sentence;
  EXPECT_NE(remarks[0].sentence.find("by chance in "), std::string::npos) << remarks[0].sentence;
}

TEST(DifferingMounts, AMountWithoutDwellsIsLikeThoseWithThem) {
  std::vector<Recording> day = recorded({"demo"});
  Recording& last = day.back();
  for (const auto cut = std::size_t(0.8 * double(last.scans())); last.time.size() > cut;) {
    last.time.pop_back(), last.pressure.pop_back(), last.condition.pop_back();
  }
  last.counts.resize(last.scans() * last.layout.size.taxels());
  EXPECT_TRUE(remarksOnDifferingMounts(day).empty());
}

TEST(DifferingMounts, AreNotToldWhereTheScatterOfMountsIsUnknown) {
  std::vector<Recording> day = recorded({"bench", 2, true});
  EXPECT_TRUE(remarksOnDifferingMounts({day[0], day[1], day[4]}).empty()) << "one surface was mounted twice";
  for (Recording& recording : day) recording.conditions[0].mount = 0;
  EXPECT_TRUE(remarksOnDifferingMounts(day).empty()) << "no numbers";
  EXPECT_TRUE(remarksOnDifferingMounts({}).empty());
  Recording without;
  EXPECT_TRUE(remarksOnDifferingMounts({without}).empty());
}

// The table in docs/training.md. Slow: run it with --gtest_also_run_disabled_tests.
TEST(DifferingMounts, DISABLED_InManyDays) {
  constexpr unsigned kFirst = 101, kSeeds = 20;
  for (const std::string rig : {"core", "bench", "demo", "remounted"}) {
    for (const int rounds : {2, 3}) {
      std::size_t clean[2] = {0, 0}, wrong[2] = {0, 0};  // [stands out, may be chance]
      for (unsigned seed = kFirst; seed < kFirst + kSeeds; ++seed) {
        for (const auto& remark : remarksOnDifferingMounts(recorded({rig, rounds, false, seed})))
          ++clean[!remark.certain()];
        for (const auto& remark : remarksOnDifferingMounts(recorded({rig, rounds, true, seed})))
          wrong[!remark.certain()] += remark.sentence.find("mount 5") != std::string::npos;
      }
      std::cout << rig << ", " << rounds << " mounts a surface: " << clean[0] << " + " << clean[1]
                << " clean days with a remark, " << wrong[0] << " + " << wrong[1]
                << " wrong mounts named, of " << kSeeds << std::endl;
    }
  }
}

}  // namespace
}  // namespace fsr::dataset
