#include "fsr_pressure_map/simulation/rig_state.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/simulation/driven_rig.h"
#include "fsr_pressure_map/simulation/session.h"

namespace {

using fsr::RigState;
using fsr::Settings;
using Counts = std::vector<std::uint16_t>;

// Every kind of memory, noise and mounts that scatter.
fsr::SimulationSettings rig(const std::string& session, const std::string& more = "") {
  return fsr::readSimulation(Settings::fromText(
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

void goThrough(fsr::Session& session, Counts& counts) {
  for (std::size_t i = 0; i < session.stations(); ++i) {
    session.runNext(
        {[&](double, const Counts& scan) { counts.insert(counts.end(), scan.begin(), scan.end()); }, {}, {}});
  }
}

RigState throughText(const RigState& state) {
  return readRigState(Settings::fromText(stateText(state), "state.yaml"));
}

TEST(RigState, ASessionInTwoPartsReadsWhatItReadsInOne) {
  Counts whole, parts;
  fsr::Session one(rig(kFlat + "," + kBent)), first(rig(kFlat)), second(rig(kBent));
  goThrough(one, whole);
  goThrough(first, parts);
  second.resume(throughText(first.state()));
  EXPECT_EQ(second.station(0).surface.mount, 2u);
  EXPECT_EQ(second.origin(), one.origin());
  goThrough(second, parts);
  EXPECT_EQ(parts, whole);
  EXPECT_EQ(stateText(second.state()), stateText(one.state()));
  fsr::Session fresh(rig(kBent));
  Counts without;
  goThrough(fresh, without);
  EXPECT_NE(without, Counts(whole.end() - static_cast<std::ptrdiff_t>(without.size()), whole.end()));
}

TEST(RigState, ADrivenRigGoesOnWhereItWasLeft) {
  const auto recordings = fsr::simulateSession(rig(kFlat + "," + kBent));
  const auto run = [](fsr::DrivenRig& driven, const fsr::Recording& recording) {
    Counts counts;
    driven.run(recording, [&](std::size_t, const fsr::SensorChain& chain) {
      counts.insert(counts.end(), chain.counts().begin(), chain.counts().end());
    });
    return counts;
  };
  fsr::DrivenRig one(rig(kFlat)), first(rig(kFlat)), second(rig(kFlat));
  run(one, recordings[0]);
  run(first, recordings[0]);
  second.resume(throughText(first.state()));
  EXPECT_EQ(run(second, recordings[1]), run(one, recordings[1]));
  EXPECT_THROW(run(second, recordings[0]), fsr::InputError);  // before what it remembers
}

TEST(RigState, ASheetThatStayedWhereItLayIsNotMountedAnew) {
  auto recordings = fsr::simulateSession(rig(kFlat + "," + kFlat));
  recordings[1].conditions[0].mount = recordings[0].conditions[0].mount;
  const auto last = [&](bool saved) {
    fsr::DrivenRig first(rig(kFlat)), second(rig(kFlat));
    const auto ignore = [](std::size_t, const fsr::SensorChain&) {};
    first.run(recordings[0], ignore);
    if (saved) second.resume(first.state());
    fsr::DrivenRig& then = saved ? second : first;
    then.run(recordings[1], ignore);
    return stateText(then.state());
  };
  EXPECT_EQ(last(true), last(false));
}

TEST(RigState, OfAnotherRigIsRefused) {
  fsr::Session other(rig(kFlat, ", turn_on: {}, time_skew: {}"));
  EXPECT_NO_THROW(other.resume(fsr::Session(rig(kFlat)).state()));  // these remember nothing
  fsr::SimulationSettings small = rig(kFlat);
  small.layout.size = {1, 1};
  EXPECT_THROW(fsr::Session(small).resume(other.state()), fsr::InputError);
  EXPECT_THROW(readRigState(Settings::fromText("{rig_state: 2}", "state.yaml")), fsr::InputError);
}

}  // namespace
