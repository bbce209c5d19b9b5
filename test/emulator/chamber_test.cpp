#include "emulator/emulator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using fsr::emulator::Chamber;
using fsr::simulation::ChamberProtocol;

// 10 s rest, 40 s up to 400 kPa, 5 s dwell, 20 s down: 75 s a cycle.
const ChamberProtocol kSlow{400e3, 10e3, 20e3, 5, 10, 2};

TEST(Chamber, RunsItsCyclesFromTheTimeOfTheCommand) {
  Chamber chamber;
  chamber.startCycles(100, kSlow);
  EXPECT_EQ(chamber.gaugePressure(99), 0);
  EXPECT_DOUBLE_EQ(chamber.gaugePressure(130), 200e3);
  EXPECT_EQ(chamber.cyclesEnd(), 250);
  EXPECT_EQ(chamber.gaugePressure(251), 0);
}

TEST(Chamber, VentsWhenStoppedAndNeverChangesThePast) {
  Chamber chamber;
  chamber.startCycles(0, kSlow);
  chamber.stop(30);
  EXPECT_DOUBLE_EQ(chamber.gaugePressure(29), 190e3);
  EXPECT_DOUBLE_EQ(chamber.gaugePressure(30), 200e3);
  EXPECT_DOUBLE_EQ(chamber.gaugePressure(35), 100e3);
  EXPECT_EQ(chamber.gaugePressure(40), 0);
  EXPECT_TRUE(std::isinf(chamber.cyclesEnd()));
}

TEST(Chamber, VentsBeforeANewRun) {
  Chamber chamber;
  chamber.startCycles(0, kSlow);
  chamber.startCycles(30, kSlow);
  EXPECT_DOUBLE_EQ(chamber.gaugePressure(35), 100e3);
  EXPECT_EQ(chamber.gaugePressure(45), 0);
  EXPECT_DOUBLE_EQ(chamber.gaugePressure(70), 200e3);
  EXPECT_EQ(chamber.cyclesEnd(), 190);
}

TEST(Chamber, ForgetsARunThatIsStoppedWhileItStillVents) {
  Chamber chamber;
  chamber.startCycles(0, kSlow);
  chamber.startCycles(30, kSlow);
  chamber.stop(35);
  EXPECT_DOUBLE_EQ(chamber.gaugePressure(36), 80e3);
  EXPECT_EQ(chamber.gaugePressure(70), 0);
}

}  // namespace
