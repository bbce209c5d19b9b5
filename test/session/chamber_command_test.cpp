#include "session/chamber_command.h"

#include <gtest/gtest.h>

#include <limits>

#include "session/rig_day.h"

namespace {

using namespace fsr::session;
using Names = std::vector<std::string>;

// A regulator that follows the command with a lag of one reading.
class Regulated {
 public:
  explicit Regulated(const fsr::session::SessionPlan& plan) : conductor(plan) {}

  void step() {
    now += 0.1;
    const double reading = unplugged ? std::numeric_limits<double>::quiet_NaN() : pressure;
    conductor.pressure(now, reading);
    conductor.scan({now, 0, 70, 0, 0});
    conductor.tick(now);
    pressure = command.next(conductor, now);
  }
  Conductor conductor;
  ChamberCommand command;
  double now = 100, pressure = 0;
  bool unplugged = false;
};

class RegulatedPlans : public testing::TestWithParam<const char*> {};

TEST_P(RegulatedPlans, NeedAPersonForTheMountsOnly) {
  const auto plan = rig_day::shipped(GetParam());
  Regulated rig(plan);
  const double limit = 2 * sessionDuration(plan);
  int confirmed = 0;
  while (!rig.conductor.done() && rig.now < limit) {
    rig.step();
    if (rig.conductor.instruction().confirm && rig.pressure == 0) confirmed += rig.conductor.confirm().done;
    for (const Outcome& outcome : rig.conductor.takeOutcomes())
      ASSERT_TRUE(outcome.verdict.accepted()) << outcome.verdict.sentence << ", step " << outcome.step + 1;
  }
  EXPECT_TRUE(rig.conductor.done()) << rig.conductor.instruction().text << rig.conductor.instruction().remark;
  EXPECT_EQ(static_cast<std::size_t>(confirmed), mountsOf(plan));
}

INSTANTIATE_TEST_SUITE_P(All, RegulatedPlans, testing::Values("paper", "every_effect", "field_check"));

TEST(ChamberCommand, VentsWhileThereIsNoReadingThenBeginsAgain) {
  Regulated rig(rig_day::planFrom(rig_day::kCycles));
  rig.step();
  rig.conductor.confirm();
  while (rig.pressure < 300e3) rig.step();
  rig.unplugged = true;
  const double begin = rig.now;
  while (rig.pressure > 0) {
    rig.step();
    ASSERT_LT(rig.now - begin, 300e3 / 17e3 + 1);
  }
  rig.unplugged = false;
  while (!rig.conductor.done() && rig.now < begin + 400) rig.step();
  EXPECT_TRUE(rig.conductor.done());
  const ConductorState state = rig.conductor.state();
  EXPECT_EQ(state.rejected, 1u);
}

TEST(ChamberCommand, StaysVentedUntilAPersonConfirms) {
  Regulated rig(rig_day::planFrom(rig_day::kCycles));
  for (int i = 0; i < 1000; ++i) {
    rig.step();
    ASSERT_EQ(rig.pressure, 0);
  }
}

}  // namespace
