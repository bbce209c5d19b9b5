#include "simulation/rig.h"

#include <gtest/gtest.h>

#include "simulation/session.h"
#include "simulation/settings_text.h"
#include "support/simulated_rig.h"

namespace {

using fsr::dataset::Recording;
using fsr::settings::InputError;
using fsr::simulation::DrivenRig;

// Two surfaces, a warming room, every kind of memory, a late clock; the reference reads finely.
fsr::simulation::SimulationSettings richRig(const std::string& more = "") {
  return fsr::simulation::readSimulation(fsr::settings::Settings::fromText(
      "{simulation: t, matrix: {rows: 2, columns: 3}, transducer: {low: 0, high: 1e6, full_counts: 16000000},"
      " program: [{hold: {pressure: 300e3, rate: 30e3, duration: 20}}, {rest: {rate: 30e3, duration: 10}}],"
      " climate: {room: [{time: 0, temperature: 23}, {time: 100, temperature: 30}]},"
      " session: [{surface: flat, flat: true}, {surface: bent, cylinder: {radius: 0.05, axis: y}, pause: "
      "30}],"
      " effects: {static_curve: {}, converter: {}, bending_preload: {}, hysteresis: {}, creep: {},"
      "           seal_leak: {}, temperature: {}, break_in: {}, time_skew: {delay: 0.1}" +
          more + "}}",
      "a.yaml"));
}

std::vector<std::uint16_t> drive(const fsr::simulation::SimulationSettings& settings,
                                 const std::vector<Recording>& through) {
  DrivenRig rig(settings);
  std::vector<std::uint16_t> counts;
  for (const Recording& recording : through) {
    rig.run(recording, [&](std::size_t, const fsr::simulation::SensorChain& chain) {
      counts.insert(counts.end(), chain.counts().begin(), chain.counts().end());
    });
  }
  return counts;
}

std::vector<std::uint16_t> countsOf(const std::vector<Recording>& recordings) {
  std::vector<std::uint16_t> counts;
  for (const Recording& r : recordings) counts.insert(counts.end(), r.counts.begin(), r.counts.end());
  return counts;
}

TEST(DrivenRig, GivesTheCountsOfTheRigThatMadeTheRecordings) {
  const auto recordings = fsr::simulation::simulateSession(richRig());
  const auto expected = countsOf(recordings), counts = drive(richRig(), recordings);
  ASSERT_EQ(counts.size(), expected.size());
  // The recorded pressure is rounded to 0.06 Pa, and straight between scans where the chamber turned.
  for (std::size_t i = 0; i < counts.size(); ++i) EXPECT_NEAR(counts[i], expected[i], 3) << i;
}

TEST(DrivenRig, FeelsTheTruePressureBehindAWrongReference) {
  const std::string error = ", transducer_error: {offset: 4e3, gain: 0.01}";
  const auto recordings = fsr::simulation::simulateSession(richRig(error));
  const auto expected = countsOf(recordings), counts = drive(richRig(error), recordings);
  for (std::size_t i = 0; i < counts.size(); ++i) EXPECT_NEAR(counts[i], expected[i], 3) << i;
  EXPECT_GT(drive(richRig(), recordings)[6 * 250], expected[6 * 250] + 20);  // without it the model is off
}

TEST(DrivenRig, TakesMatrixAndFullScaleOfTheRecording) {
  auto recordings = fsr::simulation::simulateSession(richRig());
  recordings[0].full_scale = 1023;
  recordings[0].layout.pitch_x = 0.02;
  const auto settings = fitted(test_support::rig("", 5, 5), recordings[0]);
  EXPECT_EQ(settings.fullScale(), 1023);
  EXPECT_EQ(settings.layout.size, (fsr::matrix::MatrixSize{2, 3}));
  EXPECT_EQ(settings.layout.pitch_x, 0.02);
}

TEST(DrivenRig, RefusesWhatItCannotGoThrough) {
  auto recordings = fsr::simulation::simulateSession(richRig());
  DrivenRig rig(richRig());
  const auto ignore = [](std::size_t, const fsr::simulation::SensorChain&) {};
  rig.run(recordings[1], ignore);
  EXPECT_THROW(rig.run(recordings[0], ignore), InputError);  // earlier
  Recording silent = recordings[1];
  silent.pressure.clear();
  EXPECT_THROW(DrivenRig(richRig()).run(silent, ignore), InputError);
  EXPECT_THROW(DrivenRig(test_support::rig("", 3, 3)).run(recordings[0], ignore), InputError);
}

}  // namespace
