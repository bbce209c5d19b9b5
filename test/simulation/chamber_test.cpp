#include "fsr_pressure_map/simulation/chamber.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "simulation/pressure_profile.h"
#include "simulation/settings_text.h"
#include "support/holds.h"

namespace {

using fsr::settings::InputError;
using fsr::settings::Settings;
using fsr::simulation::ChamberProtocol;
using fsr::simulation::PressureProfile;

// 10 s rest, 100 s up, 20 s at 500 kPa, 50 s down.
ChamberProtocol slopes() {
  return {500e3, 5e3, 10e3, 20, 10, 3};
}

TEST(ChamberProtocol, RestsFillsDwellsAndVents) {
  const PressureProfile profile = pressureProfile(slopes());
  EXPECT_EQ(cycleDuration(slopes()), 180);
  EXPECT_EQ(profile.duration(), 540);
  for (const double cycle_start : {0.0, 180.0, 360.0}) {
    EXPECT_DOUBLE_EQ(profile.at(cycle_start + 5), 0);
    EXPECT_DOUBLE_EQ(profile.at(cycle_start + 60), 250e3);
    EXPECT_DOUBLE_EQ(profile.at(cycle_start + 110), 500e3);
    EXPECT_DOUBLE_EQ(profile.at(cycle_start + 129), 500e3);
    EXPECT_DOUBLE_EQ(profile.at(cycle_start + 155), 250e3);
  }
  EXPECT_EQ(profile.at(-1), 0);
  EXPECT_EQ(profile.at(541), 0);
}

TEST(ChamberProtocol, DefaultsAreThePapersCycles) {
  const ChamberProtocol paper;
  EXPECT_NEAR(cycleDuration(paper) * paper.cycles * 10, 7500, 10);  // scans a condition at 10 Hz
  EXPECT_EQ(pressureProfile(paper).at(paper.dwell_rest + paper.peak / paper.fill_rate), 620e3);
}

TEST(ChamberProtocol, CyclesForEverWhenAskedForNone) {
  ChamberProtocol endless = slopes();
  endless.cycles = 0;
  const PressureProfile profile = pressureProfile(endless);
  EXPECT_TRUE(std::isinf(profile.duration()));
  EXPECT_NEAR(profile.at(180.0 * 100000 + 60), 250e3, 1);
}

TEST(ChamberProtocol, VentsFromWhereItStands) {
  const PressureProfile profile = fsr::simulation::ventingProfile(slopes(), 200e3);
  EXPECT_EQ(profile.at(0), 200e3);
  EXPECT_EQ(profile.at(10), 100e3);
  EXPECT_EQ(profile.at(1e9), 0);
  EXPECT_EQ(fsr::simulation::ventingProfile(slopes(), 0).duration(), 0);
}

TEST(ChamberProtocol, ReadsOneRateForBothWays) {
  const auto protocol = fsr::simulation::readChamberProtocol(
      Settings::fromText("{rate: 31000, cycles: 2}", "a.yaml"), slopes());
  EXPECT_EQ(protocol.fill_rate, 31e3);
  EXPECT_EQ(protocol.vent_rate, 31e3);
  EXPECT_EQ(protocol.cycles, 2u);
  EXPECT_EQ(protocol.peak, 500e3);
}

TEST(ChamberProtocol, RefusesMoreThanTheChambersRating) {
  const auto settings = Settings::fromText("peak: 800000", "a.yaml");
  EXPECT_TRUE(
      test_support::holds(test_support::refusal([&] { fsr::simulation::readChamberProtocol(settings); }),
                          {"a.yaml", "peak is 800000", "1000 to 793000 Pa", "793 kPa"}));
  ChamberProtocol protocol;
  protocol.peak = 793.1e3;
  EXPECT_THROW(validate(protocol, "~chamber"), InputError);
  protocol.peak = std::nan("");
  EXPECT_THROW(validate(protocol, "~chamber"), InputError);
  protocol = {};
  protocol.vent_rate = 0;
  EXPECT_THROW(validate(protocol, "~chamber"), InputError);
}

TEST(PressureProfile, RunsItsPartsOneAfterAnother) {
  PressureProfile profile;
  profile.append({{0, 0}, {10, 100}});
  profile.append({{0, 100}, {5, 50}, {10, 100}}, 2);
  profile.append({{0, 100}, {0, 20}, {30, 20}});  // a step
  EXPECT_EQ(profile.duration(), 60);
  EXPECT_EQ(profile.at(5), 50);
  EXPECT_EQ(profile.at(15), 50);
  EXPECT_EQ(profile.at(22.5), 75);
  EXPECT_EQ(profile.at(31), 20);
  EXPECT_EQ(profile.at(100), 20);
}

TEST(PressureProfile, RefusesTimesThatRunBackwardsAndPartsAfterTheEndlessOne) {
  PressureProfile profile;
  EXPECT_THROW(profile.append({{0, 1}}), std::invalid_argument);
  EXPECT_THROW(profile.append({{1, 1}, {2, 1}}), std::invalid_argument);
  EXPECT_THROW(profile.append({{0, 1}, {2, 1}, {1, 1}}), std::invalid_argument);
  EXPECT_THROW(profile.append({{0, 1}, {0, 1}}), std::invalid_argument);
  profile.append({{0, 1}, {2, 1}}, 0);
  EXPECT_THROW(profile.append({{0, 1}, {2, 1}}), std::invalid_argument);
}

TEST(Transducer, ReadsInStepsOfTheDaq) {
  const fsr::simulation::Transducer transducer;
  EXPECT_NEAR(transducer.step(), 277.6, 0.1);
  EXPECT_EQ(transducer.counts(-103e3), 0);
  EXPECT_EQ(transducer.counts(1034e3), 4096);
  EXPECT_EQ(transducer.counts(2e6), 4096);
  for (const double pressure : {0.0, 1234.0, 620e3}) {
    EXPECT_NEAR(transducer.gaugePressure(transducer.counts(pressure)), pressure, transducer.step() / 2);
  }
}

}  // namespace
