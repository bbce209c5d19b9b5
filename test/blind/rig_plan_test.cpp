#include "blind/rig_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "blind/random.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace blind {
namespace {

RigPlan planNumber(int number, const std::string& protocol_class = "") {
  return drawPlan(hashOf("plan " + std::to_string(number)), protocol_class, kSmallReadings);
}

double highest(const ChamberPath& path) {
  return *std::max_element(path.pressure.begin(), path.pressure.end());
}

// Peak of each cycle [share of kPeak].
std::vector<double> peaks(const ChamberPath& path) {
  std::vector<double> found(path.cycle_start.size(), 0.0);
  for (std::size_t i = 0; i < path.time.size(); ++i) {
    const auto after = std::upper_bound(path.cycle_start.begin(), path.cycle_start.end(), path.time[i]);
    if (after == path.cycle_start.begin()) continue;
    double& peak = found[static_cast<std::size_t>(after - path.cycle_start.begin() - 1)];
    peak = std::max(peak, path.pressure[i] / kPeak);
  }
  return found;
}

TEST(RigPlans, StayWithinTheirRanges) {
  std::set<std::string> classes, shapes, cuts;
  std::set<int> bits;
  std::set<std::size_t> surfaces, mounts;
  int with_thermometer = 0, exponential = 0;
  for (int i = 0; i < 400; ++i) {
    const RigPlan plan = planNumber(i);
    classes.insert(plan.protocol_class);
    shapes.insert(plan.room.shape);
    cuts.insert(plan.cut.kind);
    bits.insert(plan.bits);
    surfaces.insert(plan.radii.size());
    mounts.insert(plan.mounts);
    with_thermometer += plan.thermometer;
    exponential += plan.exponential;
    EXPECT_TRUE(plan.matrix.rows >= 4 && plan.matrix.rows <= 16) << plan.matrix.rows;
    EXPECT_TRUE(plan.matrix.columns >= 4 && plan.matrix.columns <= 10) << plan.matrix.columns;
    EXPECT_TRUE(plan.scan_rate >= 5 && plan.scan_rate <= 200) << plan.scan_rate;
    EXPECT_TRUE(plan.peak >= 40e3 && plan.peak <= 700e3) << plan.peak;
    EXPECT_LE(std::abs(plan.room.drift), 12);
    EXPECT_LE(plan.readings(), kSmallReadings);
    EXPECT_LE(plan.slowest, 10.01 * plan.fastest);
    EXPECT_EQ(plan.radii[0], 0);
    double top = 0;
    for (const PlannedVisit& visit : plan.visits) {
      const std::size_t cycles = visit.path.cycle_start.size();
      EXPECT_TRUE(cycles >= 4 && cycles <= 30) << cycles;
      EXPECT_NEAR(highest(visit.path), plan.reach[visit.surface] * kPeak, 1e-6 * kPeak);
      EXPECT_NEAR(visit.path.pressure.back(), 0, 1e-6);
      top = std::max(top, highest(visit.path));
      for (const double peak : peaks(visit.path)) EXPECT_GE(peak, 0.399 * plan.reach[visit.surface]);
    }
    EXPECT_NEAR(top, kPeak, 1e-6 * kPeak);
  }
  EXPECT_EQ(classes.size(), protocolClasses().size());
  EXPECT_EQ(shapes.size(), 4u);
  EXPECT_EQ(cuts.size(), 3u);
  EXPECT_EQ(bits, (std::set<int>{8, 10, 12, 14, 16}));
  EXPECT_EQ(surfaces.size(), 8u);
  EXPECT_EQ(mounts.size(), 3u);
  EXPECT_NEAR(with_thermometer, 240, 40);
  EXPECT_GT(exponential, 60);
}

TEST(RigPlans, AreThoseOfTheirClass) {
  for (int i = 0; i < 20; ++i) {
    const RigPlan regular = planNumber(i, "regular"), one_pace = planNumber(i, "one_pace");
    const RigPlan many = planNumber(i, "many_mounts"), brief = planNumber(i, "short");
    const RigPlan uneven = planNumber(i, "uneven_surfaces"), by_hand = planNumber(i, "hand_run");
    EXPECT_TRUE(regular.onePace());
    for (const double peak : peaks(regular.visits[0].path))
      EXPECT_NEAR(peak, regular.reach[regular.visits[0].surface], 1e-9);
    EXPECT_TRUE(one_pace.onePace());
    EXPECT_FALSE(one_pace.exponential);
    EXPECT_GT(many.visits.size(), many.radii.size());
    EXPECT_GE(many.mounts, 2u);
    EXPECT_LE(brief.radii.size(), 2u);
    EXPECT_EQ(brief.visits.size(), brief.radii.size());
    EXPECT_LT(*std::min_element(uneven.reach.begin(), uneven.reach.end()), 1);
    EXPECT_FALSE(by_hand.onePace());
  }
}

TEST(RigPlans, OfOneNameAreTheSame) {
  const RigPlan a = planNumber(7), b = planNumber(7);
  EXPECT_EQ(a.protocol_class, b.protocol_class);
  ASSERT_EQ(a.visits.size(), b.visits.size());
  for (std::size_t i = 0; i < a.visits.size(); ++i) {
    EXPECT_EQ(a.visits[i].path.time, b.visits[i].path.time);
    EXPECT_EQ(a.visits[i].path.pressure, b.visits[i].path.pressure);
  }
  EXPECT_NE(a.peak, planNumber(8).peak);
}

TEST(RigPlans, OfAnUnknownClassAreRefused) {
  EXPECT_THROW(planNumber(1, "irregular"), fsr::settings::InputError);
}

TEST(HashOf, IsFnv1a) {
  // Test vectors of the authors: http://www.isthe.com/chongo/tech/comp/fnv/
  EXPECT_EQ(hashOf(""), 0xcbf29ce484222325u);
  EXPECT_EQ(hashOf("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(hashOf("foobar"), 0x85944171f73967e8u);
}

}  // namespace
}  // namespace blind
