// A board under an operator's hands reads like a simulation file of the same course.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "emulator/board.h"
#include "emulator/operator.h"
#include "fsr_pressure_map/simulation/simulate.h"
#include "protocol/wire_decoder.h"
#include "support/packet_recorder.h"
#include "support/source_dir.h"

namespace {

using fsr::emulator::Act;
using fsr::emulator::Board;
using fsr::emulator::Operator;
using fsr::emulator::OperatorOptions;
using fsr::emulator::Task;
using fsr::emulator::TaskKind;
using fsr::simulation::ChamberProtocol;
using fsr::simulation::HoldPart;
using fsr::simulation::LoopsPart;
using fsr::simulation::RestPart;
using fsr::simulation::SimulationSettings;
using fsr::simulation::Station;

// 39 s.
const fsr::simulation::ChamberProgram kProgram = {
    RestPart{50e3, 3}, ChamberProtocol{200e3, 50e3, 50e3, 1, 1, 2}, HoldPart{150e3, 50e3, 4},
    LoopsPart{50e3, 150e3, 50e3, 1}, RestPart{50e3, 2}};

/// The instructions for one part of a program.
struct Instructions {
  std::vector<Task> operator()(const ChamberProtocol& part) const {
    Task task = of(TaskKind::kCycle, part.fill_rate);
    task.peak = part.peak;
    task.dwell_peak = part.dwell_peak;
    task.dwell_rest = part.dwell_rest;
    task.cycles = part.cycles;
    std::vector<Task> tasks(part.cycles, task);
    for (unsigned c = 0; c < part.cycles; ++c) tasks[c].cycle = c + 1;
    return tasks;
  }
  std::vector<Task> operator()(const HoldPart& part) const {
    Task task = of(TaskKind::kHold, part.rate);
    task.peak = part.pressure;
    task.dwell_peak = part.duration;
    return {task};
  }
  std::vector<Task> operator()(const LoopsPart& part) const {
    Task task = of(TaskKind::kLoop, part.rate);
    task.low = part.low;
    task.peak = part.high;
    return {task};
  }
  std::vector<Task> operator()(const RestPart& part) const {
    Task task = of(TaskKind::kRest, part.rate);
    task.dwell_rest = part.duration;
    return {task};
  }
  static Task of(TaskKind kind, double rate) {
    Task task;
    task.kind = kind;
    task.rate = rate;
    return task;
  }
};

std::vector<Task> instructions(const SimulationSettings& settings) {
  std::vector<Task> tasks;
  for (const Station& station : settings.session) {
    Task mount;
    mount.kind = TaskKind::kMount;
    mount.surface = station.surface.name;
    mount.mount = station.surface.mount;
    tasks.push_back(mount);
    for (const auto& part : station.program) {
      for (const Task& task : std::visit(Instructions{}, part)) tasks.push_back(task);
    }
  }
  for (std::size_t i = 0; i < tasks.size(); ++i) tasks[i].step = static_cast<std::uint32_t>(i + 1);
  return tasks;
}

/// The demo rig with this program on each of its first surfaces, without a pause between them.
SimulationSettings demo(std::size_t stations) {
  auto settings =
      fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/demo.yaml");
  settings.session.resize(stations);
  for (Station& station : settings.session) {
    station.pause = 0;
    station.program = kProgram;
  }
  return settings;
}

struct Scan {
  double time;  // [s]
  std::vector<std::uint16_t> counts;
};

/// The scans of a board at which an operator, without delays, follows the instructions.
class OperatedBoard : fsr::protocol::PacketHandler {
 public:
  explicit OperatedBoard(const SimulationSettings& settings, const std::vector<Task>& tasks)
      : settings_(settings), board_(settings, {}), person_(options()), tasks_(tasks) {
    board_.mount(settings.session.front().surface);
    fsr::protocol::WireDecoder decoder(*this);
    while (next_ < tasks_.size() || board_.nextDue() <= person_.doneAt()) {
      instructUntil(board_.nextDue());
      if (next_ == tasks_.size() && board_.nextDue() > person_.doneAt()) break;
      auto& packet = board_.next([this](double time) { return person_.gaugePressure(time); });
      decoder.feed(packet.data(), packet.size());
    }
  }
  std::vector<Scan> scans;

 private:
  static OperatorOptions options() {
    OperatorOptions options;
    options.habits = fsr::emulator::Habits::exact();
    return options;
  }
  void instructUntil(double time) {
    while (next_ < tasks_.size() && person_.doneAt() <= time) {
      person_.instruct(person_.doneAt(), tasks_[next_++]);
      for (const Act& act : person_.takeActs(time)) perform(act);
    }
  }
  void perform(const Act& act) {
    for (const Station& station : settings_.session) {
      if (act.kind == Act::Kind::kPutOn && station.surface.mount == act.mount) board_.mount(station.surface);
    }
  }
  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    scans.push_back({1e-6 * header.device_time, {scan.counts, scan.counts + scan.size.taxels()}});
  }
  void onTransducer(const fsr::protocol::PacketHeader&, std::int32_t) override {}
  void onTemperature(const fsr::protocol::PacketHeader&, std::int32_t) override {}
  void onIdentity(const fsr::protocol::PacketHeader&, const fsr::protocol::IdentityPacket&) override {}

  SimulationSettings settings_;
  Board board_;
  Operator person_;
  std::vector<Task> tasks_;
  std::size_t next_ = 0;
};

TEST(OperatedBoard, ReadsWithAllEffectsAndNoiseLikeTheSimulationFile) {
  const SimulationSettings settings = demo(1);
  const std::vector<Scan> live = OperatedBoard(settings, instructions(settings)).scans;
  const auto recording = fsr::simulation::simulateSession(settings).front();
  ASSERT_EQ(recording.scans(), 391u);
  ASSERT_EQ(live.size(), recording.scans());
  for (std::size_t i = 0; i < live.size(); ++i) {
    const auto* counts = recording.scan(i);
    EXPECT_TRUE(std::equal(live[i].counts.begin(), live[i].counts.end(), counts)) << "scan " << i;
  }
}

// The simulation scans the sheet on both surfaces at the time of the change, the board only on the second. So
// the numbers of the scans differ, on which noise depends, and the course of the preload during 0.1 s, which
// creep and loop remember.
TEST(OperatedBoard, KeepsTheStateOfTheSheetFromSurfaceToSurface) {
  constexpr int kTolerance = 1;  // [counts]; 1 in 100 counts differs
  SimulationSettings settings = demo(3);
  settings.effects.erase(std::remove_if(settings.effects.begin(), settings.effects.end(),
                                        [](const auto& effect) { return effect.id == "white_noise"; }),
                         settings.effects.end());
  const std::vector<Scan> live = OperatedBoard(settings, instructions(settings)).scans;
  const auto recordings = fsr::simulation::simulateSession(settings);
  ASSERT_EQ(live.size(), 3 * 390u + 1);
  std::size_t differ = 0;
  for (std::size_t station = 0; station < 3; ++station) {
    for (std::size_t i = 0; i < 390; ++i) {
      const Scan& scan = live[390 * station + i];
      ASSERT_NEAR(scan.time, 39.0 * static_cast<double>(station) + recordings[station].time[i], 1e-6);
      const auto* counts = recordings[station].scan(i);
      for (std::size_t taxel = 0; taxel < scan.counts.size(); ++taxel) {
        ASSERT_NEAR(scan.counts[taxel], counts[taxel], kTolerance) << "station " << station << ", scan " << i;
        differ += scan.counts[taxel] != counts[taxel] ? 1 : 0;
      }
    }
  }
  EXPECT_LT(static_cast<double>(differ), 0.01 * 3 * 390 * 70);
}

}  // namespace
