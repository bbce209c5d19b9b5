#include "simulation/session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "simulation/settings_text.h"
#include "support/simulated_rig.h"
#include "support/source_dir.h"

namespace {

using fsr::settings::InputError;
using fsr::settings::Settings;
using fsr::simulation::readSimulation;
using fsr::simulation::Session;
using fsr::simulation::SimulationSettings;

SimulationSettings twoStations(const std::string& effects = "") {
  return readSimulation(Settings::fromText(
      "{simulation: t, matrix: {rows: 1, columns: 2}, board: {scan_rate: 10, transducer_rate: 20},"
      " program: [{hold: {pressure: 300e3, rate: 100e3, duration: 2}}, {rest: {rate: 100e3, duration: 0}}],"
      " session: [{surface: flat, flat: true},"
      "           {surface: bent, cylinder: {radius: 0.05, axis: y}, pause: 30}],"
      " effects: {static_curve: {conductance_scatter: 0}, converter: {}, bending_preload: {}, " +
          effects + "}}",
      "a.yaml"));
}

TEST(Session, GoesThroughItsStationsInRigTime) {
  Session session(twoStations());
  std::vector<double> scans, pressures, temperatures;
  const fsr::simulation::RigListener listener{
      [&](double time, const auto&) { scans.push_back(time); },
      [&](double time, double) { pressures.push_back(time); },
      [&](double time, double) { temperatures.push_back(time); },
  };
  ASSERT_EQ(session.stations(), 2u);
  EXPECT_EQ(session.begin(), 0);
  session.runNext(listener);
  EXPECT_EQ(scans.size(), 81u);  // 8 s
  EXPECT_EQ(pressures.size(), 161u);
  EXPECT_EQ(temperatures.size(), 9u);
  EXPECT_EQ(session.begin(), 38);
  session.runNext(listener);
  EXPECT_EQ(scans[81], 38);
  EXPECT_EQ(scans.back(), 46);
}

TEST(Session, LaysTheSheetOnTheSurfacesAndItRemembers) {
  Session session(twoStations("hysteresis: {}"));
  std::vector<std::uint16_t> first, second;
  session.runNext({[&](double, const auto& counts) { first.push_back(counts[0]); }, {}, {}});
  session.runNext({[&](double, const auto& counts) { second.push_back(counts[0]); }, {}, {}});
  EXPECT_EQ(first.front(), 0);
  EXPECT_GT(first.back(), 30);              // residual of the loop
  EXPECT_GT(second.front(), first.back());  // and the preload of the bend
}

TEST(Session, IsAlsoThereAsRecordings) {
  const auto recordings = fsr::simulation::simulateSession(twoStations());
  ASSERT_EQ(recordings.size(), 2u);
  const fsr::dataset::Recording& bent = recordings[1];
  EXPECT_EQ(bent.name, "2_bent.bag");
  EXPECT_EQ(bent.sensor.serial, "SIM-0001");
  EXPECT_EQ(bent.scans(), 81u);
  ASSERT_EQ(bent.conditions.size(), 1u);
  EXPECT_EQ(bent.conditions[0].name, "bent");
  EXPECT_EQ(bent.conditions[0].mount, 2u);
  EXPECT_NEAR(bent.pressure[40], 300e3, fsr::simulation::Transducer{}.step());
  EXPECT_EQ(bent.temperature.size(), bent.scans());
  EXPECT_EQ(bent.start_ns - recordings[0].start_ns, 38000000000);
}

TEST(Session, HasAReferenceWithItsOwnErrors) {
  const auto right = fsr::simulation::simulateSession(twoStations());
  const auto wrong = fsr::simulation::simulateSession(twoStations("transducer_error: {offset: 5e3, bow: 0}"));
  EXPECT_EQ(wrong[0].counts, right[0].counts);
  EXPECT_NEAR(wrong[0].pressure[40] - right[0].pressure[40], 5e3, fsr::simulation::Transducer{}.step());
}

TEST(Session, RefusesCyclesWithoutEnd) {
  auto settings = test_support::rig();
  settings.session[0].program = {fsr::simulation::ChamberProtocol{620e3, 17e3, 17e3, 1, 1, 0}};
  EXPECT_THROW(Session{settings}, InputError);
}

TEST(Session, TakesSurfacesFromFilesBesideItsOwn) {
  const std::string file = test_support::sourceDir() + "/config/simulation/mine.yaml";  // need not exist
  const auto settings = readSimulation(Settings::fromText(
      "{simulation: t, session: [{surface: cylinder_7cm}], effects: {static_curve: {}, converter: {}}}",
      file));
  EXPECT_NEAR(settings.session[0].surface.curvature[0].x, 1 / 0.07, 1e-9);
  EXPECT_THROW(readSimulation(Settings::fromText("{simulation: t, session: [{surface: cube}], effects: "
                                                 "{static_curve: {}, converter: {}}}",
                                                 file)),
               InputError);
}

}  // namespace
