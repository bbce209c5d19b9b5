#include "simulation/rig.h"

#include <gtest/gtest.h>

#include "simulation/session.h"
#include "simulation/settings_text.h"

namespace {

using fsr::settings::Settings;
using fsr::simulation::RigState;
using Counts = std::vector<std::uint16_t>;

// Every kind of memory, noise and mounts that scatter.
fsr::simulation::SimulationSettings rememberingRig(const std::string& session, const std::string& more = "") {
  return fsr::simulation::readSimulation(Settings::fromText(
      "{simulation: t, start: 1704099600.5, matrix: {rows: 2, columns: 3},"
      " program: [{hold: {pressure: 300e3, rate: 30e3, duration: 5}}, {rest: {rate: 30e3, duration: 5}}],"
      " climate: {room: 23, heating: 1.0e-5}, session: [" +
          session +
          "],"
          " effects: {static_curve: {}, converter: {}, hysteresis: {}, creep: {}, seal_leak: {}, "
          "temperature: {},"
          "           break_in: {}, drift: {}, wear: {}, repositioning: {}, white_noise: {}" +
          more + "}}",
      "a.yaml"));
}

const std::string kFlat = "{surface: flat, flat: true}";
const std::string kBent = "{surface: bent, cylinder: {radius: 0.05, axis: y}, pause: 30}";

void goThrough(fsr::simulation::Session& session, Counts& counts) {
  for (std::size_t i = 0; i < session.stations(); ++i) {
    session.runNext(
        {[&](double, const Counts& scan) { counts.insert(counts.end(), scan.begin(), scan.end()); }, {}, {}});
  }
}

RigState throughText(const RigState& state) {
  return fsr::simulation::readRigState(Settings::fromText(stateText(state), "state.yaml"));
}

TEST(RigState, ASessionInTwoPartsReadsWhatItReadsInOne) {
  Counts whole, parts;
  fsr::simulation::Session one(rememberingRig(kFlat + "," + kBent)), first(rememberingRig(kFlat)),
      second(rememberingRig(kBent));
  goThrough(one, whole);
  goThrough(first, parts);
  second.resume(throughText(first.state()));
  EXPECT_EQ(second.station(0).surface.mount, 2u);
  EXPECT_EQ(second.origin(), one.origin());
  goThrough(second, parts);
  EXPECT_EQ(parts, whole);
  EXPECT_EQ(stateText(second.state()), stateText(one.state()));
  fsr::simulation::Session fresh(rememberingRig(kBent));
  Counts without;
  goThrough(fresh, without);
  EXPECT_NE(without, Counts(whole.end() - static_cast<std::ptrdiff_t>(without.size()), whole.end()));
}

TEST(RigState, ADrivenRigGoesOnWhereItWasLeft) {
  const auto recordings = fsr::simulation::simulateSession(rememberingRig(kFlat + "," + kBent));
  const auto run = [](fsr::simulation::DrivenRig& driven, const fsr::dataset::Recording& recording) {
    Counts counts;
    driven.run(recording, [&](std::size_t, const fsr::simulation::SensorChain& chain) {
      counts.insert(counts.end(), chain.counts().begin(), chain.counts().end());
    });
    return counts;
  };
  fsr::simulation::DrivenRig one(rememberingRig(kFlat)), first(rememberingRig(kFlat)),
      second(rememberingRig(kFlat));
  run(one, recordings[0]);
  run(first, recordings[0]);
  second.resume(throughText(first.state()));
  EXPECT_EQ(run(second, recordings[1]), run(one, recordings[1]));
  EXPECT_THROW(run(second, recordings[0]), fsr::settings::InputError);  // before what it remembers
}

TEST(RigState, ASheetThatStayedWhereItLayIsNotMountedAnew) {
  auto recordings = fsr::simulation::simulateSession(rememberingRig(kFlat + "," + kFlat));
  recordings[1].conditions[0].mount = recordings[0].conditions[0].mount;
  const auto last = [&](bool saved) {
    fsr::simulation::DrivenRig first(rememberingRig(kFlat)), second(rememberingRig(kFlat));
    const auto ignore = [](std::size_t, const fsr::simulation::SensorChain&) {};
    first.run(recordings[0], ignore);
    if (saved) second.resume(first.state());
    fsr::simulation::DrivenRig& then = saved ? second : first;
    then.run(recordings[1], ignore);
    return stateText(then.state());
  };
  EXPECT_EQ(last(true), last(false));
}

TEST(RigState, OfAnotherRigIsRefused) {
  fsr::simulation::Session other(rememberingRig(kFlat, ", turn_on: {}, time_skew: {}"));
  EXPECT_NO_THROW(
      other.resume(fsr::simulation::Session(rememberingRig(kFlat)).state()));  // these remember nothing
  fsr::simulation::SimulationSettings small = rememberingRig(kFlat);
  small.layout.size = {1, 1};
  EXPECT_THROW(fsr::simulation::Session(small).resume(other.state()), fsr::settings::InputError);
  EXPECT_THROW(fsr::simulation::readRigState(Settings::fromText("{rig_state: 2}", "state.yaml")),
               fsr::settings::InputError);
}

}  // namespace
