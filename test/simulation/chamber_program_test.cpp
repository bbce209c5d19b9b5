#include "fsr_pressure_map/simulation/chamber.h"
#include "simulation/pressure_profile.h"
#include "simulation/settings_text.h"
#include "support/holds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using fsr::settings::InputError;
using fsr::settings::Settings;
using fsr::simulation::PressureProfile;
using test_support::holds;

PressureProfile program(const std::string& parts) {
  return pressureProfile(fsr::simulation::readChamberProgram(
      Settings::fromText("program: " + parts, "a.yaml").sections("program")));
}

std::string complaintAboutProgram(const std::string& parts) {
  return test_support::refusal([&] { program(parts); }, "none");
}

TEST(ChamberProgram, RunsAnyMixtureOfParts) {
  const PressureProfile profile = program(
      "[{cycles: {peak: 200e3, rate: 20e3, dwell_peak: 0, dwell_rest: 0, cycles: 2}},"  // 20 s each
      " {hold: {pressure: 300e3, rate: 100e3, duration: 60}},"                          // 3 s, then 60 s
      " {loops: {low: 200e3, high: 400e3, rate: 20e3, loops: 3}},"                      // 5 s, then 20 s each
      " {rest: {rate: 50e3, duration: 100}}]");                                         // 4 s, then 100 s
  EXPECT_DOUBLE_EQ(profile.at(10), 200e3);
  EXPECT_DOUBLE_EQ(profile.at(30), 200e3);
  EXPECT_DOUBLE_EQ(profile.at(40), 0);
  EXPECT_DOUBLE_EQ(profile.at(41.5), 150e3);
  EXPECT_DOUBLE_EQ(profile.at(103), 300e3);
  EXPECT_DOUBLE_EQ(profile.at(108), 200e3);
  EXPECT_DOUBLE_EQ(profile.at(118), 400e3);
  EXPECT_DOUBLE_EQ(profile.at(138), 400e3);
  EXPECT_DOUBLE_EQ(profile.at(168), 200e3);
  EXPECT_DOUBLE_EQ(profile.at(172), 0);
  EXPECT_DOUBLE_EQ(profile.duration(), 272);
}

TEST(ChamberProgram, VentsBeforeCyclesThatFollowAHold) {
  const PressureProfile profile = program(
      "[{hold: {pressure: 100e3, rate: 100e3, duration: 9}},"
      " {cycles: {peak: 50e3, rate: 50e3, dwell_rest: 5, dwell_peak: 0, cycles: 1}}]");
  EXPECT_DOUBLE_EQ(profile.at(11), 50e3);
  EXPECT_DOUBLE_EQ(profile.at(12), 0);
  EXPECT_DOUBLE_EQ(profile.at(18), 50e3);
}

TEST(ChamberProgram, RefusesByName) {
  EXPECT_TRUE(holds(complaintAboutProgram("[{hold: {pressure: 800e3, duration: 1}}]"),
                    {"program[0].hold.pressure is 800e3", "793"}));
  EXPECT_TRUE(holds(complaintAboutProgram("[{rest: {duration: -1}}]"), {"program[0].rest.duration is -1"}));
  EXPECT_TRUE(
      holds(complaintAboutProgram("[{loops: {low: 3e5, high: 2e5, loops: 1}}]"), {"must be above low"}));
  EXPECT_TRUE(holds(complaintAboutProgram("[{pause: {duration: 1}}]"),
                    {"give exactly one of cycles, hold, loops, rest"}));
  EXPECT_TRUE(holds(complaintAboutProgram("[{rest: {duration: 1}, hold: {pressure: 1, duration: 1}}]"),
                    {"exactly one"}));
  EXPECT_TRUE(holds(complaintAboutProgram("[{cycles: {cycles: 0}}, {rest: {duration: 1}}]"), {"never ends"}));
}

}  // namespace
