// Speed of the sensor chain. Counters, at the scan rate of the case: `real_time` is the rig time [s]
// simulated in one second of a core, `core` is the share of a core that real time needs.

#include <benchmark/benchmark.h>

#include "emulator/board.h"
#include "simulation/effects/effect_library.h"
#include "simulation/portrait.h"
#include "simulation/pressure_profile.h"
#include "simulation/sensitivity.h"
#include "simulation/settings_text.h"

namespace {

constexpr double kPaperRate = 10;  // [Hz]

/// The usual static curve and converter, alone or with every effect at its usual size.
fsr::simulation::SimulationSettings settingsOf(int rows, int columns, bool all) {
  const std::string matrix =
      "matrix: {rows: " + std::to_string(rows) + ", columns: " + std::to_string(columns);
  fsr::simulation::SimulationSettings settings =
      fsr::simulation::readSimulation(fsr::settings::Settings::fromText(
          "{simulation: b, " + matrix + "}, effects: {static_curve: {}, converter: {}}}", "benchmark"));
  for (const fsr::simulation::EffectEntry& entry : fsr::simulation::effectLibrary()) {
    if (all && entry.make) settings = fsr::simulation::withEffect(settings, entry.info.id);
  }
  return settings;
}

void readScans(fsr::simulation::SensorChain& chain, const fsr::simulation::PressureProfile& profile,
               double rate, std::uint64_t scans) {
  const fsr::simulation::PressureCourse course = [&](double time) { return profile.at(time); };
  for (std::uint64_t i = 0; i < scans; ++i) {
    const double time = static_cast<double>(i) / rate;
    benchmark::DoNotOptimize(chain.read({time, profile.at(time), i, 23, &course}).data());
  }
}

// One scan of 7 x 10 taxels with static curve, converter and one effect: the cost of each effect.
void oneEffect(benchmark::State& state, const std::string& id) {
  const auto profile = pressureProfile(fsr::simulation::ChamberProtocol{});
  fsr::simulation::SensorChain chain(id.empty() ? settingsOf(7, 10, false)
                                                : fsr::simulation::withEffect(settingsOf(7, 10, false), id));
  for (auto _ : state) readScans(chain, profile, kPaperRate, 750);
  state.SetItemsProcessed(state.iterations() * 750);
}

// The paper's 45,000 scans of 70 taxels; target: 5,000 times real time.
void paperWithAllEffects(benchmark::State& state) {
  const auto settings = settingsOf(7, 10, true);
  const auto profile = pressureProfile(fsr::simulation::ChamberProtocol{});
  for (auto _ : state) {
    fsr::simulation::SensorChain chain(settings);
    readScans(chain, profile, kPaperRate, 45000);
  }
  state.counters["real_time"] =
      benchmark::Counter(4500.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void scans(benchmark::State& state) {
  fsr::simulation::SensorChain chain(settingsOf(7, 10, true));
  const auto profile = pressureProfile(fsr::simulation::ChamberProtocol{});
  for (auto _ : state) readScans(chain, profile, kPaperRate, static_cast<std::uint64_t>(state.range(0)));
  state.SetComplexityN(state.range(0));
}

void taxels(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  fsr::simulation::SensorChain chain(settingsOf(side, side, true));
  const auto profile = pressureProfile(fsr::simulation::ChamberProtocol{});
  for (auto _ : state) readScans(chain, profile, kPaperRate, 100);
  state.SetComplexityN(std::int64_t{side} * side);
}

// Work of the emulated board for a scan of 16 x 10 taxels at 1 kHz; target: under a fifth of a core.
void boardAtOneKilohertz(benchmark::State& state) {
  fsr::simulation::SimulationSettings settings = settingsOf(16, 10, true);
  settings.board.scan_rate = settings.board.transducer_rate = 1000;
  fsr::emulator::Board board(settings, {});
  const auto profile = pressureProfile(fsr::simulation::ChamberProtocol{});
  const fsr::simulation::PressureCourse course = [&](double time) { return profile.at(time); };
  const std::uint64_t before = board.scans();
  for (auto _ : state) benchmark::DoNotOptimize(board.next(course).data());
  state.counters["core"] = benchmark::Counter(static_cast<double>(board.scans() - before) / 1000,
                                              benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// One signature of the discrepancy search: 7,500 scans of a rig like core.yaml.
void signature(benchmark::State& state) {
  const auto settings = fsr::simulation::withEffect(settingsOf(7, 10, false), "bending_preload");
  fsr::simulation::Sensitivity creep(settings, "creep", "per_decade");
  const auto profile = pressureProfile(fsr::simulation::ChamberProtocol{});
  std::uint64_t scan = 0;
  for (auto _ : state) {
    for (int i = 0; i < 7500; ++i, ++scan) {
      const double time = static_cast<double>(scan) / kPaperRate;
      benchmark::DoNotOptimize(creep.read({time, profile.at(time), scan}).reading.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * 7500);
}

const int kRegistered = [] {
  benchmark::RegisterBenchmark("effect/none", oneEffect, std::string())->Unit(benchmark::kMicrosecond);
  for (const fsr::simulation::EffectEntry& entry : fsr::simulation::effectLibrary()) {
    if (!entry.make || entry.info.required) continue;
    benchmark::RegisterBenchmark(("effect/" + entry.info.id).c_str(), oneEffect, entry.info.id)
        ->Unit(benchmark::kMicrosecond);
  }
  return 0;
}();

BENCHMARK(paperWithAllEffects)->Unit(benchmark::kMillisecond);
BENCHMARK(scans)->Arg(1000)->Arg(4000)->Arg(16000)->Arg(45000)->Complexity()->Unit(benchmark::kMillisecond);
BENCHMARK(taxels)->Arg(4)->Arg(8)->Arg(16)->Arg(32)->Arg(64)->Complexity()->Unit(benchmark::kMillisecond);
BENCHMARK(boardAtOneKilohertz)->Unit(benchmark::kMicrosecond);
BENCHMARK(signature)->Unit(benchmark::kMillisecond);

}  // namespace
