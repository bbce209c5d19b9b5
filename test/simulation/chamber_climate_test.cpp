#include "fsr_pressure_map/simulation/chamber.h"
#include "simulation/rig.h"
#include "simulation/settings_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using fsr::settings::Settings;
using fsr::simulation::ChamberGas;

fsr::simulation::ChamberClimate climate(const std::string& text) {
  return fsr::simulation::readChamberClimate(Settings::fromText(text, "a.yaml"));
}

TEST(ChamberClimate, IsTwentyThreeDegreesWhereNothingIsSaid) {
  ChamberGas gas(fsr::simulation::ChamberClimate{});
  EXPECT_EQ(gas.temperature(0, 0), 23);
  EXPECT_EQ(gas.temperature(1000, 620e3), 23);
}

TEST(ChamberClimate, FollowsTheRoom) {
  ChamberGas gas(climate("room: [{time: 100, temperature: 20}, {time: 200, temperature: 30}]"));
  EXPECT_EQ(gas.temperature(0, 0), 20);
  EXPECT_EQ(gas.temperature(150, 0), 25);
  EXPECT_EQ(gas.temperature(900, 0), 30);
  EXPECT_EQ(ChamberGas(climate("room: 31")).temperature(5, 0), 31);
}

TEST(ChamberClimate, HeatsTheGasThatIsCompressedAndCoolsTheGasThatExpands) {
  ChamberGas gas(climate("{room: 20, heating: 1e-5, cooling: 20}"));
  gas.temperature(0, 0);
  EXPECT_NEAR(gas.temperature(0.001, 600e3), 26, 0.001);
  EXPECT_NEAR(gas.temperature(20.001, 600e3), 20 + 6 * std::exp(-1), 0.001);
  gas.temperature(1000, 600e3);
  EXPECT_NEAR(gas.temperature(1000.001, 0), 14, 0.001);
}

TEST(ChamberClimate, RefusesByName) {
  EXPECT_THROW(climate("room: 200"), fsr::settings::InputError);
  EXPECT_THROW(climate("cooling: 0"), fsr::settings::InputError);
  EXPECT_THROW(climate("room: [{time: 5, temperature: 20}, {time: 5, temperature: 21}]"),
               fsr::settings::InputError);
}

}  // namespace
