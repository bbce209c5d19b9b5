#include "fsr_pressure_map/simulation/chamber.h"
#include "simulation/pressure_profile.h"
#include "simulation/settings_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using fsr::settings::InputError;
using fsr::settings::Settings;
using fsr::simulation::PressureProfile;

PressureProfile program(const std::string& parts) {
  return pressureProfile(fsr::simulation::readChamberProgram(
      Settings::fromText("program: " + parts, "a.yaml").sections("program")));
}

std::string complaintAbout(const std::string& parts) {
  try {
    program(parts);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
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
  EXPECT_NE(
      complaintAbout("[{hold: {pressure: 800e3, duration: 1}}]").find("program[0].hold.pressure is 800e3"),
      std::string::npos);
  EXPECT_NE(complaintAbout("[{hold: {pressure: 800e3, duration: 1}}]").find("793"), std::string::npos);
  EXPECT_NE(complaintAbout("[{rest: {duration: -1}}]").find("program[0].rest.duration is -1"),
            std::string::npos);
  EXPECT_NE(complaintAbout("[{loops: {low: 3e5, high: 2e5, loops: 1}}]").find("must be above low"),
            std::string::npos);
  EXPECT_NE(complaintAbout("[{pause: {duration: 1}}]").find("give exactly one of cycles, hold, loops, rest"),
            std::string::npos);
  EXPECT_NE(complaintAbout("[{rest: {duration: 1}, hold: {pressure: 1, duration: 1}}]").find("exactly one"),
            std::string::npos);
  EXPECT_NE(complaintAbout("[{cycles: {cycles: 0}}, {rest: {duration: 1}}]").find("never ends"),
            std::string::npos);
}

}  // namespace
