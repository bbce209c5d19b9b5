#include "emulator/emulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "simulation/pressure_profile.h"
#include "support/board_listener.h"
#include "support/clumsy_operator.h"
#include "support/pty.h"
#include "support/source_dir.h"

namespace {

using namespace std::chrono_literals;
using fsr::emulator::Emulator;
using fsr::emulator::EmulatorOptions;
using fsr::emulator::LineDamage;
using fsr::emulator::RigStatus;
using fsr::matrix::Curvature;
using fsr::matrix::Surface;
using test_support::BoardListener;

constexpr auto kLong = 30s;  // limit for events that must happen; no test waits that long

/// The bench rig at two hundred times real time.
EmulatorOptions bench() {
  EmulatorOptions options;
  options.simulation =
      fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/bench.yaml");
  options.time_scale = 200;
  return options;
}

/// Reads until a scan of this rig time or later [s]. Scans from before a command may still be in the port,
/// hundreds of them on a busy machine. Only the stamp shows which scans came after it.
bool hears(BoardListener& listener, const Emulator& rig, double time) {
  return listener.until(
      [&] { return !listener.scans.empty() && rig.rigTime(listener.scans.back().device_time) >= time; });
}

Surface cylinder() {
  return {"cylinder_7cm", 2, {Curvature{1 / 0.07, 0, 0}}, {}};
}

/// Counts of the sensor chain for the pressures of scans 0, 1, 2 ... on these surfaces.
class Replay {
 public:
  explicit Replay(const fsr::simulation::SimulationSettings& settings) : chain_(settings) {}
  std::vector<std::uint16_t> scan(double time, double pressure, const Surface& surface) {
    chain_.mount(surface);
    return chain_.read({time, pressure, number_++});
  }

 private:
  fsr::simulation::SensorChain chain_;
  std::uint64_t number_ = 0;
};

TEST(Emulator, SendsTransducerReadingsOfThePressureAtTheirStamps) {
  EmulatorOptions options = bench();
  options.autostart = true;
  Emulator rig(options);
  BoardListener listener(rig.port());
  ASSERT_TRUE(listener.until([&] { return rig.status().state == RigStatus::State::kDone; }));
  const fsr::simulation::Transducer& line = options.simulation.transducer;
  const fsr::simulation::PressureProfile protocol = pressureProfile(options.simulation.chamber);
  double highest = 0;
  for (const auto& reading : listener.transducer) {
    const double time = rig.rigTime(reading.device_time);
    EXPECT_NEAR(rig.gaugePressure(time), protocol.at(time), 1e-6);
    EXPECT_NEAR(line.gaugePressure(reading.value), protocol.at(time), line.step() / 2 + 1e-6);
    highest = std::max(highest, line.gaugePressure(reading.value));
  }
  EXPECT_NEAR(highest, 300e3, 3000);
}

TEST(Emulator, SendsTheCountsOfTheSensorChainForPressureAndSurfaceAtTheStamp) {
  EmulatorOptions options = bench();
  options.autostart = true;
  Emulator rig(options);
  BoardListener listener(rig.port());
  ASSERT_TRUE(rig.waitForReader(kLong));
  ASSERT_TRUE(listener.untilScans(60));
  rig.setSurface(cylinder());
  ASSERT_TRUE(hears(listener, rig, rig.rigTime() + 120 / options.simulation.board.scan_rate));
  // The listener may have missed the first scans. The chain computes all of them; the test compares those
  // that were received.
  Replay replay(options.simulation);
  std::size_t heard = 0, bent = 0;
  for (std::uint32_t number = 0; heard < listener.scans.size(); ++number) {
    const double time = number / options.simulation.board.scan_rate;
    const Surface surface = rig.surface(time);
    const auto expected = replay.scan(time, rig.gaugePressure(time), surface);
    if (listener.scans[heard].sequence != number) continue;
    EXPECT_EQ(listener.scans[heard++].counts, expected) << "scan " << number;
    bent += surface.name == "cylinder_7cm" ? 1 : 0;
  }
  EXPECT_GT(bent, 50u);
  EXPECT_LT(bent, heard);
}

TEST(Emulator, KeepsTheSpacingOfRigTimeAtAnyTimeScale) {
  EmulatorOptions options = bench();
  options.time_scale = 20;
  const auto start = std::chrono::steady_clock::now();
  Emulator rig(options);
  BoardListener listener(rig.port());
  ASSERT_TRUE(listener.untilScans(101));
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  for (std::size_t i = 1; i < listener.scans.size(); ++i) {
    EXPECT_EQ(listener.scans[i].device_time - listener.scans[i - 1].device_time, 50000u);
  }
  EXPECT_GE(wall.count(), 100 * 0.05 / 20) << "rig time may wait, but never runs ahead of its schedule";
}

TEST(Emulator, ReportsRigTimeBeforeEachScanAndInOrder) {
  EmulatorOptions options = bench();
  std::mutex mutex;
  std::vector<double> times;
  options.on_clock = [&](double time) {
    const std::lock_guard<std::mutex> lock(mutex);
    times.push_back(time);
  };
  Emulator rig(options);
  BoardListener listener(rig.port());
  ASSERT_TRUE(listener.untilScans(50));
  std::unique_lock<std::mutex> lock(mutex);
  const std::vector<double> told = times;
  lock.unlock();
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  for (const auto& scan : listener.scans) {
    const double time = rig.rigTime(scan.device_time);
    const auto nearest = std::lower_bound(told.begin(), told.end(), time - 1e-6);
    ASSERT_NE(nearest, told.end());
    EXPECT_NEAR(*nearest, time, 1e-6);
  }
}

TEST(Emulator, ReportsTheEndOfARunAndStartsANewOne) {
  Emulator rig(bench());
  EXPECT_EQ(rig.status().state, RigStatus::State::kIdle);
  EXPECT_EQ(rig.startCycles(), 1u);
  ASSERT_TRUE(rig.waitForStatus(RigStatus::State::kDone, kLong));
  const double first_end = rig.rigTime();
  EXPECT_EQ(rig.startCycles(), 2u);
  EXPECT_EQ(rig.status().state, RigStatus::State::kRunning);
  ASSERT_TRUE(rig.waitForStatus(RigStatus::State::kDone, kLong));
  EXPECT_GE(rig.rigTime() - first_end, 24);  // two cycles of 12 s
}

TEST(Emulator, VentsWhenStopped) {
  Emulator rig(bench());
  rig.startCycles();
  ASSERT_TRUE(rig.waitForRigTime(rig.rigTime() + 5, kLong));
  rig.stopCycles();
  EXPECT_EQ(rig.status().state, RigStatus::State::kStopped);
  ASSERT_TRUE(rig.waitForRigTime(rig.rigTime() + 6, kLong));
  EXPECT_EQ(rig.gaugePressure(rig.rigTime()), 0);
}

TEST(EmulatorDamage, UnpluggingRemovesThePortAndPluggingInRestoresItsName) {
  const test_support::TemporaryFolder folder;
  EmulatorOptions options = bench();
  options.link = folder.path("board");
  Emulator rig(options);
  EXPECT_EQ(rig.port(), options.link);
  {
    BoardListener listener(rig.port());
    ASSERT_TRUE(listener.untilScans(10));
    LineDamage damage;
    damage.unplugged = true;
    rig.setDamage(damage);
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(options.link)));
    EXPECT_THROW(listener.until([] { return false; }), fsr::protocol::LinkError);
  }
  rig.setDamage({});
  BoardListener listener(rig.port());
  EXPECT_TRUE(listener.untilScans(10));
}

TEST(EmulatorLine, ASlowReaderLosesWholePacketsAndNeverBlocksTheBoard) {
  EmulatorOptions options = bench();
  options.time_scale = 1;
  options.simulation.layout.size = {32, 32};
  options.simulation.board.scan_rate = 1000;
  Emulator rig(options);
  BoardListener listener(rig.port());
  // The port is open but not read. Rig time continues.
  ASSERT_TRUE(rig.waitForReader(kLong));
  while (rig.counts().dropped < 10) ASSERT_TRUE(rig.waitForRigTime(rig.rigTime() + 0.02, kLong));
  ASSERT_TRUE(listener.untilScans(50));
  EXPECT_GT(listener.counts().of(fsr::protocol::PacketType::kScan).lost, 0u);
  EXPECT_EQ(listener.counts().skipped_bytes, 0u) << "no packet in pieces";
}

// On a busy computer the emulator's thread may run late. A board does not, so no packet may be lost because
// of this.
TEST(EmulatorLine, ADelayOfTheEmulatorLosesNothing) {
  EmulatorOptions options = bench();
  options.time_scale = 1;
  options.simulation.layout.size = {32, 32};
  options.simulation.board.scan_rate = 100;  // the port buffers 0.3 s of scans
  int packets = 0;
  options.on_packet = [&packets](const std::vector<std::uint8_t>&) {
    if (++packets == 10) std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  };
  Emulator rig(options);
  BoardListener listener(rig.port());
  // Until the emulator has caught up, it also waits for a reader that is slow on a busy machine, but not
  // later.
  ASSERT_TRUE(listener.untilScans(110));
  EXPECT_EQ(listener.counts().of(fsr::protocol::PacketType::kScan).lost, 0u);
}

TEST(EmulatorLine, ScaledRigTimeWaitsForASlowReaderButNotForEver) {
  EmulatorOptions options = bench();
  options.time_scale = 500;
  Emulator rig(options);
  BoardListener listener(rig.port());
  ASSERT_TRUE(rig.waitForReader(kLong));
  ASSERT_TRUE(listener.untilScans(2000));
  EXPECT_EQ(listener.counts().of(fsr::protocol::PacketType::kScan).lost, 0u);
  const double then = rig.rigTime();
  EXPECT_TRUE(rig.waitForRigTime(then + 500, kLong)) << "although the port is not read any more";
}

TEST(EmulatorLine, AReaderReceivesNothingFromBeforeItOpenedThePort) {
  Emulator rig(bench());
  {
    BoardListener earlier(rig.port());
    ASSERT_TRUE(earlier.untilScans(5));
  }
  ASSERT_TRUE(rig.waitForRigTime(rig.rigTime() + 20, kLong));
  const double opened = rig.rigTime();
  BoardListener listener(rig.port());
  ASSERT_TRUE(listener.untilScans(1));
  EXPECT_GT(rig.rigTime(listener.scans[0].device_time), opened - 0.1);
}

// --- an operator at the rig ------------------------------------------------------------------------

using fsr::emulator::Act;
using fsr::emulator::Task;
using fsr::emulator::TaskKind;

/// The bench rig with an operator who takes 5 s to change the surface.
EmulatorOptions operated() {
  EmulatorOptions options = bench();
  test_support::ClumsyOptions clumsy;
  clumsy.person.habits = fsr::emulator::Habits::exact();
  clumsy.person.habits.change_least = clumsy.person.habits.change_most = 5;
  options.person = std::make_shared<test_support::ClumsyOperator>(clumsy);
  options.surface_called = [](const std::string& name) {
    if (name == "cylinder_7cm") return cylinder();
    if (name == "flat") return Surface{"flat", 1, {Curvature{}}, {}};
    throw fsr::settings::InputError("there is no surface " + name);
  };
  return options;
}

Task mountTask(const std::string& surface, std::uint32_t mount) {
  Task task;
  task.kind = TaskKind::kMount;
  task.surface = surface;
  task.mount = mount;
  task.confirm = true;
  return task;
}

Task cycleTask() {
  Task task;
  task.kind = TaskKind::kCycle;
  task.step = 2;
  task.peak = 300e3;
  task.rate = 100e3;
  task.cycle = task.cycles = 1;
  return task;
}

TEST(EmulatorOperator, PutsTheSheetOnASurfaceAndPressesAsInstructed) {
  EmulatorOptions options = operated();
  std::mutex mutex;
  std::vector<Act> acts;
  options.on_act = [&](const Act& act) {
    const std::lock_guard<std::mutex> lock(mutex);
    acts.push_back(act);
  };
  Emulator rig(options);
  rig.instruct(mountTask("cylinder_7cm", 4));
  const double asked = rig.rigTime();
  ASSERT_TRUE(rig.waitForRigTime(asked + 6, kLong));
  {
    const std::lock_guard<std::mutex> lock(mutex);
    ASSERT_EQ(acts.size(), 3u);
    EXPECT_EQ(acts[2].kind, Act::Kind::kConfirm);
  }
  EXPECT_EQ(rig.surface(rig.rigTime()).name, "cylinder_7cm");
  EXPECT_EQ(rig.surface(rig.rigTime()).mount, 4u);
  rig.instruct(cycleTask());
  const double begin = rig.rigTime();
  ASSERT_TRUE(rig.waitForRigTime(begin + 7, kLong));
  double highest = 0;
  for (double time = begin - 1; time < begin + 6; time += 0.01) {
    highest = std::max(highest, rig.gaugePressure(time));
  }
  EXPECT_NEAR(highest, 300e3, 1e3);
  EXPECT_EQ(rig.gaugePressure(rig.rigTime()), 0);
}

TEST(EmulatorOperator, IsTheOnlyOneWhoWorksTheChamber) {
  Emulator rig(operated()), alone(bench());
  EXPECT_THROW(rig.startCycles(), fsr::settings::InputError);
  EXPECT_THROW(rig.stopCycles(), fsr::settings::InputError);
  EXPECT_THROW(rig.setSurface(cylinder()), fsr::settings::InputError);
  EXPECT_THROW(rig.instruct(mountTask("cube", 1)), fsr::settings::InputError);
  EXPECT_THROW(alone.instruct(cycleTask()), fsr::settings::InputError);
}

TEST(Emulator, RefusesImpossibleOptions) {
  EmulatorOptions options = bench();
  options.time_scale = 0;
  EXPECT_THROW(Emulator{options}, fsr::settings::InputError);
  options = bench();
  options.baud = 1200;
  EXPECT_THROW(Emulator{options}, fsr::settings::InputError);
  options = bench();
  options.simulation.board.scan_duration = 0.1;
  EXPECT_THROW(Emulator{options}, fsr::settings::InputError);
  options = bench();
  options.simulation.chamber.peak = 800e3;
  EXPECT_THROW(Emulator{options}, fsr::settings::InputError);
  const test_support::TemporaryFolder folder;
  options = bench();
  options.link = folder.path("board");
  std::ofstream(options.link) << "a file that must not be overwritten";
  EXPECT_THROW(Emulator{options}, fsr::settings::InputError);
  EXPECT_TRUE(std::filesystem::is_regular_file(options.link));
}

TEST(Emulator, ASurfaceOfAnotherSizeIsRefusedAndChangesNothing) {
  Emulator rig(bench());
  EXPECT_THROW(rig.setSurface({"limb", 2, std::vector<Curvature>(5), {}}), fsr::settings::InputError);
  EXPECT_EQ(rig.surface(rig.rigTime()).name, "flat");
}

}  // namespace
